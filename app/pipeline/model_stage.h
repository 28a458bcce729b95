// SPDX-License-Identifier: MIT
#pragma once

#include "app/pipeline/frame_statistics.h"
#include "app/pipeline/hold_out.h"
#include "app/pipeline/photometric_aligner.h"
#include "app/pipeline/pose_stage.h"
#include "app/pipeline/shared_model.h"
#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "core/visibility/visibility.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace sheen::app {

/// Second stage: posed image -> visibility -> samples -> fit. The only place that counts frames.
class ModelStage {
 public:
  /// The interfaces between the modules; mesh and light fields are borrowed.
  struct Parts {
    std::unique_ptr<core::Visibility> visibility;
    const core::Mesh& mesh;
    core::CameraModel camera;
    Eigen::Isometry3d board_from_object;
    core::SamplingLimits limits;
    SharedModel& model;
    fitting::Fitter* baseline;  ///< integrates the same samples for comparison; may be null
    HoldOut hold_out;
    PhotometricOptions photometric = {};
    int threads = 1;
    /// Asked before a frame's samples are taken in, on the thread that fits; false keeps them out.
    /// May be empty.
    std::function<bool(const core::SampleBatch&)> admit = {};
  };

  explicit ModelStage(Parts parts);

  /// Takes a frame into the model unless it has no pose or is held out.
  void integrate(TrackedFrame& tracked);

  /// A frame's pose refined against the light field as it is now, or as it was when that cannot be
  /// said. Only with `refine_poses`; changes no statistics.
  PosedFrame refined(const capture::Frame& frame, PosedFrame posed);

  [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }

 private:
  std::optional<PosedFrame> count(const TrackedFrame& tracked);
  void observe(const capture::Frame& frame, core::StageTimes& times, PosedFrame& posed);
  void see(const Eigen::Isometry3d& camera_from_object);
  std::optional<core::Alignment> align(const capture::Frame& frame, PosedFrame& posed);
  void correct_exposure();
  void integrate_samples(core::StageTimes& times);

  Parts parts_;
  core::SurfacePoints points_;
  core::VertexView view_;
  core::SampleBatch batch_;
  std::optional<PhotometricAligner> aligner_;  ///< where something is adjusted
  FrameStatistics statistics_;
};

}  // namespace sheen::app
