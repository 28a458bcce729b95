// SPDX-License-Identifier: MIT
#include "pipeline/frame_statistics.h"

#include "pipeline/pose_stage.h"

namespace sheen::pipeline {

std::optional<PosedFrame> FrameStatistics::count(const TrackedFrame& tracked) {
  if (frames_read++ == 0) {
    first_index = tracked.frame.index;
    first_s = tracked.frame.time_s;
  }
  last_index = tracked.frame.index;
  last_s = tracked.frame.time_s;
  if (const auto* rejection = std::get_if<capture::PoseRejection>(&tracked.pose)) {
    ++pose_rejections[std::string(name_of(*rejection))];
    return std::nullopt;
  }
  const auto& pose = std::get<capture::FramePose>(tracked.pose);
  if (pose.tags > 0) reprojection_px.push_back(pose.reprojection_px);
  return PosedFrame{tracked.frame.index, tracked.frame.time_s, pose.camera_from_board,
                    pose.readout_motion};
}

}  // namespace sheen::pipeline
