// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "render/renderer.h"

#include <Eigen/Geometry>

#include <vector>

namespace sheen::evaluation {

/// A camera that walks round an object, a quarter of a degree from one image to the next.
struct SmoothPath {
  core::CameraModel camera;
  std::vector<Eigen::Isometry3d> camera_from_object;
};

/// Sixteen degrees round `centre` (metres) about `axis` (unit vector), with `pose` in the middle;
/// images of `camera`, made at most 320 pixels wide. Both are in the object's frame.
SmoothPath smooth_path(const core::CameraModel& camera, const Eigen::Isometry3d& pose,
                       const Eigen::Vector3d& centre, const Eigen::Vector3d& axis);

/// The largest change from one image to the next over the median one: 1 where all is smooth, large
/// where something jumps. A change is the root mean square over the pixels that either image
/// covers. 1 where nothing changes or is seen.
double pop_ratio(render::Renderer& renderer, const SmoothPath& path);

}  // namespace sheen::evaluation
