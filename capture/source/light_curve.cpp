// SPDX-License-Identifier: MIT
#include "capture/source/light_curve.h"

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr int kCodes = 1 << 14;
constexpr double kReferenceWhite_cd = 203;  // ITU-R BT.2408
constexpr double kHlgPeak_cd = 1000;        // the display that HLG's reference OOTF is for
constexpr double kPqPeak_cd = 10000;

/// ITU-R BT.2100, HLG: signal to scene light, 1 at the peak.
double hlg_scene_light(double signal) {
  constexpr double a = 0.17883277, b = 0.28466892, c = 0.55991073;
  return signal <= 0.5 ? signal * signal / 3 : (std::exp((signal - c) / a) + b) / 12;
}

/// ITU-R BT.2100, PQ: signal to light of the display, cd/m^2.
double pq_light_cd(double signal) {
  constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 4096 * 128, c1 = 3424.0 / 4096,
                   c2 = 2413.0 / 4096 * 32, c3 = 2392.0 / 4096 * 32;
  const double root = std::pow(signal, 1 / m2);
  return kPqPeak_cd * std::pow(std::max(root - c1, 0.0) / (c2 - c3 * root), 1 / m1);
}

double srgb_light(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double srgb_code(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

double light_of(LightCurve curve, double code) {
  switch (curve) {
    case LightCurve::linear:
      return code;
    case LightCurve::hlg:
      return hlg_scene_light(code);
    case LightCurve::pq:
      return pq_light_cd(code) / kReferenceWhite_cd;
    case LightCurve::srgb:
      break;
  }
  return srgb_light(code);
}

/// Linear light of the primaries to that of BT.709, both with the white point D65.
Eigen::Matrix3f to_bt709(WidePrimaries primaries) {
  Eigen::Matrix3f matrix = Eigen::Matrix3f::Identity();
  if (primaries == WidePrimaries::bt2020) {       // ITU-R BT.2087
    matrix << 1.660491f, -0.587641f, -0.072850f,  //
        -0.124550f, 1.132900f, -0.008349f,        //
        -0.018151f, -0.100579f, 1.118730f;
  } else if (primaries == WidePrimaries::display_p3) {
    matrix << 1.224940f, -0.224940f, 0.0f,  //
        -0.042057f, 1.042057f, 0.0f,        //
        -0.019638f, -0.078636f, 1.098274f;
  }
  return matrix;
}

}  // namespace

LightConverter::LightConverter(LightCurve curve, WidePrimaries primaries)
    : is_hlg_(curve == LightCurve::hlg), srgb_from_source_(to_bt709(primaries)) {
  light_.reserve(1 << 16);
  for (int i = 0; i < 1 << 16; ++i) {
    light_.push_back(static_cast<float>(light_of(curve, i / 65535.0)));
  }
  code_.reserve(kCodes + 1);
  for (int i = 0; i <= kCodes; ++i) {
    // Steps of the root: sRGB's curve is steep near black.
    const double root = i / static_cast<double>(kCodes);
    code_.push_back(static_cast<std::uint8_t>(std::lround(255 * srgb_code(root * root))));
  }
}

void LightConverter::convert(const std::uint16_t* bgr16, std::uint8_t* bgr8, int pixels) const {
  for (int i = 0; i < pixels; ++i, bgr16 += 3, bgr8 += 3) {
    Eigen::Vector3f light(light_[bgr16[2]], light_[bgr16[1]], light_[bgr16[0]]);
    if (is_hlg_) {
      // The display's part (OOTF): brightness to the power of 1.2, hue kept.
      const float luminance = Eigen::Vector3f(0.2627f, 0.6780f, 0.0593f).dot(light);
      light *= std::pow(luminance, 0.2f) * static_cast<float>(kHlgPeak_cd / kReferenceWhite_cd);
    }
    light = (srgb_from_source_ * light).cwiseMax(0.0f).cwiseMin(1.0f);
    for (int channel = 0; channel < 3; ++channel) {
      const float root = std::sqrt(light[channel]);
      bgr8[2 - channel] = code_[static_cast<std::size_t>(root * kCodes + 0.5f)];
    }
  }
}

}  // namespace sheen::capture
