// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <ceres/cost_function.h>

#include <array>

namespace sheen::capture {

/// A rigid transform as Ceres moves it: rotation vector, translation.
using Parameters = std::array<double, 6>;

Parameters to_parameters(const Eigen::Isometry3d& transform);
Eigen::Isometry3d to_isometry(const Parameters& parameters);

/// Focal lengths, principal point, the lens's eight coefficients.
using LensParameters = std::array<double, 12>;
inline constexpr std::size_t kFirstHighTerm = 8;  ///< index of a rational lens's k3

LensParameters lens_parameters(const core::CameraModel& camera);

/// `camera` with another lens, of the same image size.
core::CameraModel camera_with(const LensParameters& lens, const core::CameraModel& camera);

/// Distance of the four corners of one tag in one view from where the layout puts them, px: 8
/// residuals of camera_from_board and board_from_tag (Parameters each). The arguments must outlive
/// the result, which the caller owns.
ceres::CostFunction* tag_residual(const core::CameraModel& camera, const TagDetection& seen,
                                  double size_m);

/// The same of camera_from_board, board_from_tag and the lens (LensParameters) of this kind.
ceres::CostFunction* tag_and_lens_residual(core::LensKind kind, const TagDetection& seen,
                                           double size_m);

}  // namespace sheen::capture
