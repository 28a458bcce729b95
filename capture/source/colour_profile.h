// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace sheen::capture {

/// Brings pictures with a colour profile to sRGB (littlecms, relative colorimetric).
class ColourProfile {
 public:
  ColourProfile();
  ~ColourProfile();
  ColourProfile(ColourProfile&&) noexcept;
  ColourProfile& operator=(ColourProfile&&) noexcept;
  ColourProfile(const ColourProfile&) = delete;
  ColourProfile& operator=(const ColourProfile&) = delete;

  /// Takes an ICC profile; false when it cannot be read or is not of RGB colours.
  bool take_icc(std::span<const std::uint8_t> bytes);
  /// Adobe RGB (1998), which cameras name without a profile.
  bool take_adobe_rgb();

  /// Whether the profile is sRGB, to a step of 8 bits: then pictures stay as they are.
  [[nodiscard]] bool is_srgb() const;
  [[nodiscard]] const std::string& name() const;

  /// Converts CV_8UC3, BGR, in place.
  void convert(cv::Mat& bgr) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
