// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/pose_estimator.h"
#include "capture/source/frame_source.h"
#include "core/diagnostics/stage_timer.h"
#include "pipeline/frame_corrections.h"

#include <functional>
#include <memory>
#include <optional>

namespace sheen::pipeline {

/// An image and where it was taken from, on its way from stage to stage. The image is
/// that of one pose and, where the session needs it, of one light (FrameCorrections).
struct TrackedFrame {
  capture::Frame frame;
  capture::PoseResult pose = capture::PoseRejection::no_tags;
  core::StageTimes times;
};

/// First stage: image -> pose, and the image corrected by it.
class PoseStage {
 public:
  /// Without corrections images stay as they are: where only their poses are of interest.
  PoseStage(std::unique_ptr<capture::FrameSource> frames,
            std::unique_ptr<capture::PoseEstimator> poses,
            std::optional<FrameCorrections> corrections = std::nullopt);

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
  std::optional<FrameCorrections> corrections_;
};

}  // namespace sheen::pipeline
