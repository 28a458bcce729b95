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

}  // namespace sheen::core
