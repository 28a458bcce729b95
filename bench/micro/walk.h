// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace sheen::bench {

/// The synthetic sessions' object of about `vertices` vertices and views from a walk round it, with
/// their camera at 1280x720, lens distortion included: what a stage of a frame works on, without
/// the images.
struct Walk {
  core::Mesh mesh;
  core::CameraModel camera;
  std::vector<Eigen::Isometry3d> camera_from_object;
};

/// Made once for every size; not to be called from several threads.
const Walk& walk_round(int vertices);

}  // namespace sheen::bench
