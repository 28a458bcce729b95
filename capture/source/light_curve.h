// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace sheen::capture {

/// How a coded value stands for light.
enum class LightCurve { srgb, linear, hlg, pq };

/// Colours that another space than sRGB spans.
enum class WidePrimaries { none, bt2020, display_p3 };

/// Coded colours (16 bits a channel) to 8-bit sRGB: to light by the curve, to the primaries of sRGB
/// by a matrix, clipped to what sRGB spans, coded by sRGB's own curve. 1 is reference white.
class LightConverter {
 public:
  LightConverter(LightCurve curve, WidePrimaries primaries);

  /// One row of `pixels` pixels, blue green red.
  void convert(const std::uint16_t* bgr16, std::uint8_t* bgr8, int pixels) const;

 private:
  bool is_hlg_;
  std::vector<float> light_;        ///< of every 16-bit value
  std::vector<std::uint8_t> code_;  ///< sRGB of light in [0, 1], kCodes steps
  Eigen::Matrix3f srgb_from_source_;
};

}  // namespace sheen::capture
