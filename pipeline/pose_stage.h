// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/pose_estimator.h"
#include "capture/source/frame_source.h"
#include "core/diagnostics/stage_timer.h"

#include <memory>
#include <optional>

namespace sheen::pipeline {

/// An image and where it was taken from, on its way from stage to stage.
struct TrackedFrame {
  capture::Frame frame;
  capture::PoseResult pose = capture::PoseRejection::no_tags;
  core::StageTimes times;
};

/// First stage: image -> pose.
class PoseStage {
 public:
  PoseStage(std::unique_ptr<capture::FrameSource> frames,
            std::unique_ptr<capture::PoseEstimator> poses);

  /// The next frame; nothing at the end of the recording.
  std::optional<TrackedFrame> next();

 private:
  std::unique_ptr<capture::FrameSource> frames_;
  std::unique_ptr<capture::PoseEstimator> poses_;
};

}  // namespace sheen::pipeline
