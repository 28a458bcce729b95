// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/depth_images.h"
#include "capture/session/session.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/hold_out.h"
#include "pipeline/options.h"
#include "pipeline/photometric_aligner.h"
#include "pipeline/pose_stage.h"
#include "pipeline/shared_model.h"
#include "pipeline/view_observer.h"

#include <functional>
#include <optional>
#include <vector>

namespace sheen::pipeline {

class CaptureEvidence;

/// Gets a frame's index and its samples as they are integrated.
using SamplesListener = std::function<void(int frame_index, const core::SampleBatch& samples)>;

/// A view as it was integrated: enough to observe it once more.
struct IntegratedView {
  int frame_index = 0;
  Eigen::Isometry3d camera_from_object = Eigen::Isometry3d::Identity();
  double gain = 1;  ///< by which its samples were divided
  /// Before any refinement: what its image was rectified with.
  PosedFrame tracked{};
};

/// Second stage: posed image -> observation -> fit. The only place that counts frames.
class FitStage {
 public:
  /// What it works with; borrowed.
  struct Parts {
    const capture::Session& session;
    const core::Mesh& mesh;
    ViewObserver& observer;
    SharedModel& model;
    fitting::Fitter* mean;      ///< integrates the same samples for comparison; may be null
    CaptureEvidence& evidence;  ///< looks at what is fitted
    HoldOut hold_out;
    const capture::DepthImages* depth = nullptr;  ///< read for every frame that is fitted
    PhotometricOptions photometric = {};
    core::PatchShare share = {};  ///< whose samples are fitted
    /// Asked before a frame's samples are integrated, on the thread that fits; false keeps them
    /// out. May be empty.
    std::function<bool(const core::SampleBatch&)> admit = {};
    SamplesListener on_samples = {};
  };

  explicit FitStage(Parts parts);

  /// Takes a frame into the model unless it has no pose or is held out.
  void integrate(TrackedFrame& tracked);

  /// Counts what the recording left out.
  void note_damaged(int frames) { statistics_.damaged = frames; }

  /// A frame's pose refined against the light field as it is now, or as it was when that cannot be
  /// said. Only with `refine_poses`; changes no statistics.
  PosedFrame refined(const capture::Frame& frame, PosedFrame posed);

  [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }
  /// In order; only those that the model still holds after an undo are of use.
  [[nodiscard]] const std::vector<IntegratedView>& integrated() const { return integrated_; }

 private:
  void observe(const capture::Frame& frame, core::StageTimes& times, PosedFrame& posed);
  std::optional<core::Alignment> align(const capture::Frame& frame, PosedFrame& posed);
  double correct_exposure(core::SampleBatch& batch);
  void fit(const core::Observation& observation, core::StageTimes& times);

  Parts parts_;
  std::optional<PhotometricAligner> aligner_;  ///< where something is adjusted
  FrameStatistics statistics_;
  std::vector<IntegratedView> integrated_;
};

}  // namespace sheen::pipeline
