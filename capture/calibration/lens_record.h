// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sheen::capture {

/// What a camera file says, in OpenCV's conventions: pixel (0, 0) is the centre of the first pixel.
struct LensRecord {
  int width_px = 0, height_px = 0;
  Eigen::Vector2d focal_px{0, 0}, principal_px{0, 0};
  core::LensKind kind = core::LensKind::rational;
  /// As the file has it: k1 k2 p1 p2 k3 ... of a rational lens (plumb_bob, radtan,
  /// rational_polynomial), k1 k2 k3 k4 of a fisheye (equidistant, Kannala and Brandt); none where
  /// the lens bends nothing.
  std::vector<double> distortion;
};

/// The values of a camera file by the names of their keys, whatever its form: words as written.
using CameraKeys = std::map<std::string, std::vector<std::string>>;

/// Throws core::Error (bad_input).
[[noreturn]] void refuse_camera_file(
    const std::filesystem::path& path, const std::string& fault,
    const std::string& remedy = "see docs/input.md for the camera files that are read");

/// A camera from a record that is believable: image size, focal lengths, principal point,
/// distortion that does not fold the image. The one place where a kind of lens becomes a camera.
/// Throws core::Error (bad_input), `path` is for messages.
core::CameraModel camera_of(const LensRecord& record, const std::filesystem::path& path);

}  // namespace sheen::capture
