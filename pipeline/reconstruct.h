// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board_refinement.h"
#include "capture/session/session.h"
#include "capture/source/frame_source.h"
#include "core/diagnostics/stage_timer.h"
#include "core/mesh/mesh.h"
#include "fitting/fitter.h"
#include "fitting/undo/undoable_fitter.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/fit_stage.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/mesh_heights.h"
#include "pipeline/mesh_placement.h"
#include "pipeline/options.h"
#include "pipeline/pose_stage.h"
#include "pipeline/progress_sink.h"
#include "pipeline/shared_model.h"

#include <memory>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// What is reconstructed from.
struct ReconstructionInputs {
  capture::Session session;
  /// Frames of the session; null: its own, as options.frames says.
  std::unique_ptr<capture::FrameSource> frames = nullptr;
  VisibilityFactory make_visibility = {};
  /// The recording is being made: it cannot be looked at before its frames come.
  bool is_live = false;
  /// Gets every view's samples just as they are fitted, on the thread that fits. May be empty.
  SamplesListener on_samples = {};
};

/// Whoever watches frames being fitted, on the thread that fits.
class FrameListener {
 public:
  virtual ~FrameListener() = default;
  /// Before a view is integrated; false keeps it out.
  virtual bool admit(const core::SampleBatch& /*batch*/) { return true; }
  /// After every frame; what it throws ends the run.
  virtual void on_frame(const TrackedFrame& /*tracked*/, const FrameStatistics& /*frames*/) {}
};

/// A light field from a session: frames are posed, observed and fitted. Made in two steps, so that
/// somebody may look at the model while it grows.
class Reconstruction {
 public:
  /// Opens all that may be wrong: mesh, poses, settings. Reads the recording, or part of it, where
  /// texels, a refined board or a refined mesh ask for it. Throws core::Error, or
  /// std::invalid_argument for settings that the representation refuses.
  Reconstruction(ReconstructionInputs inputs, const ReconstructionOptions& options,
                 ProgressSink& sink);
  ~Reconstruction();
  Reconstruction(Reconstruction&& other) noexcept;
  Reconstruction& operator=(Reconstruction&& other) noexcept;
  Reconstruction(const Reconstruction&) = delete;
  Reconstruction& operator=(const Reconstruction&) = delete;

  /// Fits every frame and finishes the model. `listener` may be null. Notes what the data show to
  /// be wrong with the recording, while it is being made as soon as that is seen. Throws
  /// core::Error (bad_input) when nothing was posed or seen.
  void run(ProgressSink& sink, FrameListener* listener = nullptr);

  [[nodiscard]] const capture::Session& session() const;
  /// The surface that the light field lies on: the session's mesh, refined where that was asked for
  /// and accepted, subdivided for texel patches.
  [[nodiscard]] const core::Mesh& mesh() const;
  /// The session's mesh as it is seen, at its place, before any refinement or subdivision.
  [[nodiscard]] const core::Mesh& object_mesh() const;
  [[nodiscard]] const ReconstructionOptions& options() const;
  [[nodiscard]] const fitting::LightField& light_field() const;
  [[nodiscard]] fitting::FitStatistics fit_statistics() const;
  /// Mean colours of the same samples; null unless options.with_mean or they are what is fitted.
  [[nodiscard]] const fitting::LightField* mean_colours() const;
  [[nodiscard]] const FrameStatistics& frames() const;
  /// What `run` found to be wrong with the recording.
  [[nodiscard]] const std::vector<Finding>& findings() const;
  [[nodiscard]] const core::StageTimer& times() const;
  [[nodiscard]] double finish_cpu_ms() const;  ///< CPU time of what the fit put off to the end
  [[nodiscard]] const std::optional<capture::BoardRefinement>& board_refinement() const;
  /// Nothing where the mesh was not measured (options.refine_mesh) or is right.
  [[nodiscard]] const std::optional<MeshPlacement>& mesh_placement() const;
  /// Nothing where it was not tried (options.refine_mesh).
  [[nodiscard]] const std::optional<MeshRefinement>& mesh_refinement() const;

  /// A held-out frame's pose refined against the finished model; with `refine_poses` only.
  PosedFrame refined(const capture::Frame& frame, const PosedFrame& posed);

  /// For whoever watches: the model between threads, and its views to be taken back (null without
  /// options.undoable).
  SharedModel& model();
  fitting::UndoableFitter* history();
  fitting::UndoableFitter* mean_history();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// All at once.
Reconstruction reconstruct(ReconstructionInputs inputs, const ReconstructionOptions& options,
                           ProgressSink& sink);

}  // namespace sheen::pipeline
