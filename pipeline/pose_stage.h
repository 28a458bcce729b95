// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/pose_estimator.h"
#include "capture/source/frame_source.h"
#include "core/diagnostics/stage_timer.h"
#include "pipeline/row_rectifier.h"

#include <functional>
#include <memory>
#include <optional>

namespace sheen::pipeline {

/// An image and where it was taken from, on its way from stage to stage. Whatever the camera's
/// shutter, the image is that of one pose (RowRectifier).
struct TrackedFrame {
  capture::Frame frame;
  capture::PoseResult pose = capture::PoseRejection::no_tags;
  core::StageTimes times;
};

/// First stage: image -> pose, and the image of that pose.
class PoseStage {
 public:
  /// Without a rectifier images stay as they are: where only their poses are of interest.
  PoseStage(std::unique_ptr<capture::FrameSource> frames,
            std::unique_ptr<capture::PoseEstimator> poses,
            std::optional<RowRectifier> rectifier = std::nullopt);

  /// The next frame; nothing at the end of the recording. Frames that `is_wanted` (may be empty)
  /// does not want are passed over without a pose.
  std::optional<TrackedFrame> next(
      const std::function<bool(const capture::Frame&)>& is_wanted = {});

  [[nodiscard]] std::optional<int> frame_count() const { return frames_->frame_count(); }

  /// What there is to say about the recording, after its last frame.
  [[nodiscard]] capture::SourceReport report() const { return frames_->report(); }

 private:
  std::unique_ptr<capture::FrameSource> frames_;
  std::unique_ptr<capture::PoseEstimator> poses_;
  std::optional<RowRectifier> rectifier_;
};

}  // namespace sheen::pipeline
