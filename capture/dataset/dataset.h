// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// One image of a data set.
struct DatasetFrame {
  std::string image;       ///< relative to the data set's folder, with / between its parts
  std::size_t camera = 0;  ///< index into Dataset::cameras
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();  ///< x right, y down
  std::optional<double> sharpness{};  ///< as instant-ngp has it: any unit, larger is sharper
  std::string mask{};                 ///< image of what counts, like `image`; empty: all of it
  bool is_held_out = false;           ///< kept for comparisons; written, not read
};

/// A coloured point of the surface, from which other programs begin.
struct DatasetPoint {
  Eigen::Vector3d position{0, 0, 0};      ///< world frame
  Eigen::Vector3i colour{128, 128, 128};  ///< sRGB, 0 to 255
};

/// Posed images as other programs exchange them. Cameras are in OpenCV's conventions here (pixel
/// (0, 0) is the centre of the first one, y down, z forward), whatever the files have: those of
/// nerfstudio, instant-ngp and COLMAP count pixels from the corner of the first one. A pixel whose
/// centre is x here has its left edge at x - 1/2 from the first centre, which is x there, and its
/// centre at x + 1/2 there: readers take 1/2 off the principal point, writers add it.
struct Dataset {
  std::vector<core::CameraModel> cameras;
  std::vector<DatasetFrame> frames;  ///< in the files' order
  std::vector<DatasetPoint> points;  ///< written, not read: an import brings its mesh
  std::string surface{};             ///< PLY file that has the points, too; empty: none
};

/// No honest description of a capture is larger; what is larger is refused unread.
inline constexpr std::size_t kMostDatasetBytes = std::size_t{1} << 28;

/// A rotation that was written with few digits -> the nearest exact one; no value for what is not
/// finite or further than 1e-3 from a rotation in any product of two columns (scaled, mirrored).
std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& written);

/// The name of an image as a file has it, "./" taken off. Throws core::Error (bad_input) for one
/// that is empty, absolute, leaves the data set's folder or holds control characters.
std::string image_within(const std::filesystem::path& file, const std::string& written);

}  // namespace sheen::capture
