// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <filesystem>
#include <optional>

namespace sheen::capture {

/// What is believed of a camera before its images are looked at.
struct LensPrior {
  ImageSize size;
  double focal_px = 0;      ///< across; times `pixel_aspect` down
  double focal_sigma = 0;   ///< of the focal length's logarithm
  bool is_stated = false;   ///< by the camera, in EXIF; else a guess
  double pixel_aspect = 1;  ///< width of a pixel over its height
};

/// 60 degrees across the longer side, as shown: between a phone's 70 and a webcam's 55.
LensPrior guessed_lens(const ImageSize& size, double pixel_aspect = 1);

/// By the focal length that EXIF states as that of 35 mm film with the same diagonal.
LensPrior stated_lens(const ImageSize& size, double focal_35mm);

/// By the EXIF of a picture, JPEG as a rule; the guess where it says nothing.
LensPrior lens_of_picture(const std::filesystem::path& picture, const ImageSize& size);

}  // namespace sheen::capture
