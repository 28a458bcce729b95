// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Core>

#include <vector>

namespace sheen::render {

/// The rays of a camera, lens included, where they meet the plane z = 1: exact at every fourth
/// pixel's corner, bilinear between them. A lens bends so little within four pixels that this is
/// right to some thousandths of a pixel, and undoing a lens takes as long as reading a JPEG.
class RayGrid {
 public:
  RayGrid() = default;
  explicit RayGrid(const core::CameraModel& camera);

  [[nodiscard]] const core::CameraModel& camera() const { return camera_; }

  /// Of any point of the image plane, pixels; exact beyond the image's border and beside points
  /// without a ray. NaN where the lens model has none.
  [[nodiscard]] Eigen::Vector2f at(double x_px, double y_px) const;

 private:
  [[nodiscard]] Eigen::Vector2f exact(double x_px, double y_px) const;

  core::CameraModel camera_;
  int columns_ = 0, rows_ = 0;
  std::vector<Eigen::Vector2f> nodes_;  ///< row by row, from the image's corner
};

}  // namespace sheen::render
