// SPDX-License-Identifier: MIT
#include "pipeline/pose_stage.h"

#include <utility>

namespace sheen::pipeline {

PoseStage::PoseStage(std::unique_ptr<capture::FrameSource> frames,
                     std::unique_ptr<capture::PoseEstimator> poses,
                     std::optional<FrameCorrections> corrections)
    : frames_(std::move(frames)), poses_(std::move(poses)), corrections_(std::move(corrections)) {}

std::optional<TrackedFrame> PoseStage::next(
    const std::function<bool(const capture::Frame&)>& is_wanted) {
  TrackedFrame tracked;
  {
    const auto timing = tracked.times.measure("decode");
    auto frame = frames_->next();
    while (frame && is_wanted && !is_wanted(*frame)) frame = frames_->next();
    if (!frame) return std::nullopt;
    tracked.frame = std::move(*frame);
  }
  {
    const auto timing = tracked.times.measure("pose");
    tracked.pose = poses_->estimate(tracked.frame);
  }
  const auto* pose = std::get_if<capture::FramePose>(&tracked.pose);
  if (corrections_ && pose != nullptr) {
    const auto timing = tracked.times.measure("correct");
    tracked.frame =
        corrections_->correct(tracked.frame, pose->camera_from_board, pose->readout_motion);
  }
  return tracked;
}

}  // namespace sheen::pipeline
