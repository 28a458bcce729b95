// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>

namespace sheen::capture {

/// How a viewer should turn the stored pixels before it shows them, as EXIF or a video's display
/// matrix says. Poses and intrinsics belong to the stored pixels, so that this is obeyed only where
/// the camera file can be meant in no other way.
struct Orientation {
  int clockwise_degrees = 0;  ///< 0, 90, 180 or 270, after mirroring
  bool is_mirrored = false;   ///< left and right exchanged first

  [[nodiscard]] bool is_upright() const { return clockwise_degrees == 0 && !is_mirrored; }
  [[nodiscard]] bool swaps_sides() const { return clockwise_degrees % 180 == 90; }
};

/// "turned by 90 degrees"
std::string describe(const Orientation& orientation);

/// What becomes of images of one stored size under a camera file for `expected`.
struct TurnChoice {
  bool turns = false;  ///< the camera file is for the turned images
  std::string note;    ///< to be said, without the file's name; empty where nothing is
};

/// Whether stored pixels have a camera's size, or their turned ones.
bool can_have_size(const ImageSize& stored, const ImageSize& expected,
                   const Orientation& orientation);

/// Stored pixels where they have the camera's size; turned ones where only those have it. Throws
/// core::Error (bad_input) naming both sizes where neither has.
TurnChoice choose_turn(const std::filesystem::path& subject, const ImageSize& stored,
                       const ImageSize& expected, const Orientation& orientation);

/// The image as a viewer would show it.
cv::Mat turned(const cv::Mat& image, const Orientation& orientation);

}  // namespace sheen::capture
