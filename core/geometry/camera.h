// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>

namespace sheen::core {

/// OpenCV's pinhole camera with rational radial and tangential distortion (docs/conventions.md).
/// Camera frame: x right, y down, z forward. Pixel (0, 0) is the centre of the first pixel.
class CameraModel {
 public:
  struct Intrinsics {
    int width_px = 0;
    int height_px = 0;
    Eigen::Vector2d focal_px{0, 0};
    Eigen::Vector2d principal_px{0, 0};
    /// k1 k2 p1 p2 k3 k4 k5 k6; the missing ones of a 4- or 5-coefficient model are zero.
    std::array<double, 8> distortion{};
  };

  CameraModel() = default;
  explicit CameraModel(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] int width_px() const { return intrinsics_.width_px; }
  [[nodiscard]] int height_px() const { return intrinsics_.height_px; }

  /// Largest distance from the optical axis, in the plane z = 1, up to which the radial polynomial
  /// grows. Beyond it the polynomial folds back and points far outside would land in the image.
  [[nodiscard]] double valid_radius() const { return valid_radius_; }

  /// Ideal position in the plane z = 1 -> position the lens makes of it, same plane.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;

  /// Inverse of `distort` by Newton steps; no value where the lens model has no inverse.
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  /// Point in the camera frame (metres) -> pixel; no value behind the camera or beyond
  /// `valid_radius`. The pixel may lie outside the image.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(
      const Eigen::Vector3d& point_in_camera) const;

  /// Pixel -> point of its ray in the plane z = 1 of the camera frame.
  [[nodiscard]] std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const;

 private:
  Intrinsics intrinsics_;
  double valid_radius_ = 0;
};

}  // namespace sheen::core
