// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <vector>

namespace sheen::capture {

/// A frame whose camera is known.
struct PosedFrameIndex {
  int index = 0;  ///< of the frame in its recording
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
};

/// A frame worth looking at.
struct ChosenView {
  PosedFrameIndex frame;
  double weight = 1;  ///< (0, 1], 1 for the slowest
};

/// At most `count` frames spread over the recording: the slowest of each stretch, since a moving
/// camera smears and a rolling shutter bends. Speed is that of `centre_in_board` in the image
/// between neighbouring frames of `frames`, which ascend by index.
std::vector<ChosenView> choose_views(const std::vector<PosedFrameIndex>& frames,
                                     const core::CameraModel& camera,
                                     const Eigen::Vector3d& centre_in_board, int count);

}  // namespace sheen::capture
