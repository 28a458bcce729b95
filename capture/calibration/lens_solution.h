// SPDX-License-Identifier: MIT
#pragma once

#include "capture/calibration/calibration_target.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace sheen::capture {

/// A lens and where the target was in every view, by least squares.
struct LensSolution {
  core::CameraModel camera;
  Eigen::Vector2d focal_sigma_px{0, 0};      ///< standard deviations, from the residuals
  Eigen::Vector2d principal_sigma_px{0, 0};  ///< likewise
  std::vector<Eigen::Isometry3d> camera_from_target;
};

/// A fisheye lens (LensKind::fisheye, k1 to k4 as far as the views tell them from zero) by bundle
/// adjustment, begun at the field of view that fits best of some. Nothing where none fits.
std::optional<LensSolution> solve_fisheye(const std::vector<TargetView>& views,
                                          const ImageSize& size);

}  // namespace sheen::capture
