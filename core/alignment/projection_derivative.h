// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Core>

#include <optional>

namespace sheen::core {

/// A projected point and how its pixel moves with it.
struct ProjectedPoint {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> pixel_by_point;  ///< px per metre, camera frame
};

/// CameraModel::project with its derivative, through the lens. No value where `project` has none.
std::optional<ProjectedPoint> project_with_derivative(const CameraModel& camera,
                                                      const Eigen::Vector3d& point_in_camera);

/// How a pixel moves with a turn (about axes through the point where `arm` begins; radians) and a
/// shift (metres) of the point where it ends: 2 x 6. From the camera's centre the arm is the point
/// itself.
Eigen::Matrix<double, 2, 6> pixel_by_twist(const Eigen::Matrix<double, 2, 3>& pixel_by_point,
                                           const Eigen::Vector3d& arm);

}  // namespace sheen::core
