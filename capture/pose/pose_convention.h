// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <optional>
#include <span>
#include <string>

namespace sheen::capture {

/// How poses of other programs differ from ours, and what to do.
struct PoseConvention {
  std::string fault;
  std::string remedy;
};

/// Under which other convention (inverted, axes of OpenGL, quaternions that begin with w, or two of
/// these) a point of the board's frame, seen in few images under ours, would be in nearly all of
/// them. Nothing where there is none.
std::optional<PoseConvention> other_convention(std::span<const Eigen::Isometry3d> camera_from_board,
                                               const core::CameraModel& camera,
                                               const Eigen::Vector3d& in_board);

}  // namespace sheen::capture
