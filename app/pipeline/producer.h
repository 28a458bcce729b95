// SPDX-License-Identifier: MIT
#pragma once

#include "app/pipeline/photometric_aligner.h"
#include "capture/pose/pose_estimator.h"
#include "capture/source/frame_source.h"
#include "core/diagnostics/stage_timer.h"
#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/visibility.h"
#include "fitting/representation.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// A frame that got a pose.
struct PosedFrame {
  int index = 0;
  double time_s = 0;
  Eigen::Isometry3d camera_from_stage = Eigen::Isometry3d::Identity();
};

/// Everything the producer counts. Complete after the last step.
struct ProducerStatistics {
  int frames_read = 0;
  int frames_fitted = 0;
  std::vector<PosedFrame> posed;               ///< in recorded order, held-out ones included
  std::vector<PosedFrame> held_out;            ///< posed, kept out of the fit
  std::map<std::string, int> pose_rejections;  ///< by name of PoseRejection
  std::array<std::size_t, core::kVertexRejectionCount> vertex_rejections{};
  std::vector<double> reprojection_px;  ///< of frames posed from tags
  std::vector<double> refined_px;       ///< mean motion of every frame whose pose was refined
  std::vector<double> gains;            ///< exposure of every frame that told it
};

/// Which frames stay out of the fit: index % every == every / 2; 0 keeps none out.
struct HoldOut {
  int every = 0;
  [[nodiscard]] bool contains(int frame_index) const {
    return every > 0 && frame_index % every == every / 2;
  }
};

/// What one frame came to, for whoever watches.
struct FrameReport {
  int frames_read = 0;
  int frames_posed = 0;
  fitting::ModelUpdate update;  ///< patches the frame changed
};

/// Frame -> pose -> visibility -> samples -> fit, one frame a step. Holds no thread: the pipeline
/// decides where it runs.
class Producer {
 public:
  /// The doors between the rooms; the light fields and the mesh are borrowed.
  struct Parts {
    std::unique_ptr<capture::FrameSource> frames;
    std::unique_ptr<capture::PoseEstimator> poses;
    std::unique_ptr<core::Visibility> visibility;
    const core::Mesh& mesh;
    core::CameraModel camera;
    Eigen::Isometry3d stage_from_object;
    core::SamplingLimits limits;
    fitting::Representation& representation;
    fitting::Representation* baseline;  ///< absorbs the same samples for comparison; may be null
    HoldOut hold_out;
    PhotometricOptions photometric = {};
    int threads = 1;
  };

  explicit Producer(Parts parts);

  /// Processes the next frame; nothing at the end of the recording.
  std::optional<FrameReport> step();

  /// A frame's pose refined against the light field as it is now, or as it was when that cannot be
  /// said. Only with `refine_poses`; changes no statistics.
  PosedFrame refined(const capture::Frame& frame, PosedFrame posed);

  [[nodiscard]] const ProducerStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const core::StageTimer& timer() const { return timer_; }

 private:
  std::optional<capture::FramePose> pose_of(const capture::Frame& frame);
  void observe(const capture::Frame& frame, PosedFrame& posed);
  void see(const Eigen::Isometry3d& camera_from_object);
  std::optional<core::Alignment> align(const capture::Frame& frame, PosedFrame& posed);
  void correct_exposure();
  fitting::ModelUpdate fit();

  Parts parts_;
  std::vector<core::TangentFrame> tangent_frames_;
  core::VertexView view_;
  core::SampleBatch batch_;
  std::optional<PhotometricAligner> aligner_;  ///< where something is adjusted
  ProducerStatistics statistics_;
  core::StageTimer timer_;
};

}  // namespace sheen::app
