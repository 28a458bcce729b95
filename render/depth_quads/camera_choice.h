// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "fitting/depth_quads/depth_quads.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace sheen::render {

/// A photograph that is drawn for a view.
struct ChosenCamera {
  std::size_t photograph_idx;
  float share;  ///< (0, 1]; falls to 0 as the next-ranked photograph takes its place
};

/// The photographs that are drawn for a view, the best first, at most as many as the options say.
/// All show something of the object within the view. With `hard` blending as in the paper: of those
/// that look the same way up to the view's field, by their distance from the viewing axis. Else by
/// the angle at the middle of the object between photograph and view, and by what a photograph
/// lacks in resolution.
std::vector<ChosenCamera> choose_cameras(const fitting::depth_quads::DepthQuads& quads,
                                         const core::CameraModel& camera,
                                         const Eigen::Isometry3d& camera_from_object);

}  // namespace sheen::render
