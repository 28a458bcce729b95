// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/lens/lens.h"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace sheen::core {

/// A camera with a lens (docs/conventions.md; core/geometry/lens/lens.h has the kinds of lenses).
/// Camera frame: x right, y down, z forward. Pixel (0, 0) is the centre of the first pixel.
class CameraModel {
 public:
  struct Intrinsics {
    int width_px = 0;
    int height_px = 0;
    Eigen::Vector2d focal_px{0, 0};
    Eigen::Vector2d principal_px{0, 0};
    /// Of a rational lens k1 k2 p1 p2 k3 k4 k5 k6, of a fisheye k1 k2 k3 k4; the others are zero.
    std::array<double, 8> distortion{};
    LensKind lens = LensKind::rational;
    /// From when the first row is read to when the last one is; 0 for a global shutter, negative
    /// for one that reads upwards.
    double readout_s = 0;

    friend bool operator==(const Intrinsics&, const Intrinsics&) = default;
  };

  CameraModel() = default;
  explicit CameraModel(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] int width_px() const { return intrinsics_.width_px; }
  [[nodiscard]] int height_px() const { return intrinsics_.height_px; }

  /// Largest distance from the optical axis, in the plane z = 1, up to which the lens moves points
  /// outwards. Beyond it the polynomial folds back and points far outside would land in the image.
  [[nodiscard]] double valid_radius() const { return valid_radius_; }

  /// Whether straight lines are curved in the image.
  [[nodiscard]] bool curves_lines() const;

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
