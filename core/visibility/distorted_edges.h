// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <array>

namespace sheen::core {

/// Whether straight edges between the pixels of a triangle's corners (object frame, metres) are no
/// good image of it: the middle of an edge lies more than a quarter of a pixel beside its line,
/// or a corner has no pixel and the triangle is not small enough to lie outside the image for
/// that.
bool has_distorted_edge(const CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                        const std::array<Eigen::Vector3f, 3>& corners);

}  // namespace sheen::core
