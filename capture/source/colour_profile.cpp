// SPDX-License-Identifier: MIT
#include "capture/source/colour_profile.h"

#include "core/text/number.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace sheen::capture {
namespace {

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct DeleteTransform {
  void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
using Profile = std::unique_ptr<void, CloseProfile>;
using Transform = std::unique_ptr<void, DeleteTransform>;

std::string name_of(void* profile) {
  std::array<char, 64> text{};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size());
  return core::quotable(text.data());
}

/// Whether colours spread over the cube stay where they are, to one step.
bool changes_nothing(void* transform) {
  constexpr int steps = 9;
  std::vector<std::uint8_t> before, after;
  for (int i = 0; i < steps * steps * steps; ++i) {
    for (const int level : {i % steps, i / steps % steps, i / steps / steps}) {
      before.push_back(static_cast<std::uint8_t>(level * 255 / (steps - 1)));
    }
  }
  after.resize(before.size());
  cmsDoTransform(transform, before.data(), after.data(),
                 static_cast<cmsUInt32Number>(before.size() / 3));
  return std::equal(before.begin(), before.end(), after.begin(),
                    [](int a, int b) { return std::abs(a - b) <= 1; });
}

}  // namespace

struct ColourProfile::Impl {
  Transform transform;
  bool is_srgb = true;
  std::string name;

  bool take(Profile source) {
    if (!source || cmsGetColorSpace(source.get()) != cmsSigRgbData) return false;
    const Profile srgb(cmsCreate_sRGBProfile());
    transform.reset(cmsCreateTransform(source.get(), TYPE_BGR_8, srgb.get(), TYPE_BGR_8,
                                       INTENT_RELATIVE_COLORIMETRIC,
                                       cmsFLAGS_BLACKPOINTCOMPENSATION));
    if (!transform) return false;
    name = name_of(source.get());
    is_srgb = changes_nothing(transform.get());
    return true;
  }
};

ColourProfile::ColourProfile() : impl_(std::make_unique<Impl>()) {}
ColourProfile::~ColourProfile() = default;
ColourProfile::ColourProfile(ColourProfile&&) noexcept = default;
ColourProfile& ColourProfile::operator=(ColourProfile&&) noexcept = default;

bool ColourProfile::take_icc(std::span<const std::uint8_t> bytes) {
  return impl_->take(
      Profile(cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size()))));
}

bool ColourProfile::take_adobe_rgb() {
  const cmsCIExyY white = {0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* gamma = cmsBuildGamma(nullptr, 563.0 / 256);
  if (gamma == nullptr) return false;
  cmsToneCurve* curves[3] = {gamma, gamma, gamma};
  Profile profile(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(gamma);
  const bool is_taken = impl_->take(std::move(profile));
  impl_->name = "Adobe RGB (1998)";
  return is_taken;
}

bool ColourProfile::is_srgb() const {
  return impl_->is_srgb;
}

const std::string& ColourProfile::name() const {
  return impl_->name;
}

void ColourProfile::convert(cv::Mat& bgr) const {
  if (!impl_->transform) return;
  for (int row = 0; row < bgr.rows; ++row) {
    cmsDoTransform(impl_->transform.get(), bgr.ptr(row), bgr.ptr(row),
                   static_cast<cmsUInt32Number>(bgr.cols));
  }
}

}  // namespace sheen::capture
