// SPDX-License-Identifier: MIT
#include "pipeline/pose_stage.h"

#include <utility>

namespace sheen::pipeline {

PoseStage::PoseStage(std::unique_ptr<capture::FrameSource> frames,
                     std::unique_ptr<capture::PoseEstimator> poses)
    : frames_(std::move(frames)), poses_(std::move(poses)) {}

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
  return tracked;
}

}  // namespace sheen::pipeline
