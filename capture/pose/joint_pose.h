// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace sheen::capture {

/// One pose over all corners of all known tags.
struct JointPose {
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  double rms_px = 0;         ///< root mean square over the corners of the tags in `tag_ids`
  std::vector<int> tag_ids;  ///< tags that carry the pose, ascending
};

/// Robust pose of the camera over the board. Detections of ids the board does not hold are passed
/// over; ids must not repeat. No value when no known tag is left or no start converges with the
/// board in front of the camera.
std::optional<JointPose> estimate_joint_pose(const Board& board, const core::CameraModel& camera,
                                             const std::vector<TagDetection>& detections);

}  // namespace sheen::capture
