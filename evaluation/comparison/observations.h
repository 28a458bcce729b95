// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "fitting/fitter.h"
#include "pipeline/fit_stage.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <filesystem>
#include <vector>

namespace sheen::evaluation {

/// What a recording says about its object, worked out once for all candidates.
struct Observations {
  capture::Session session;
  core::Mesh mesh;
  std::vector<pipeline::IntegratedView> views;  ///< the fitted frames, in recorded order
  std::vector<core::SampleBatch> samples;       ///< of each of them
  capture::Session held_out_session;            ///< whose frames `held_out` counts
  std::vector<pipeline::PosedFrame> held_out;   ///< views no candidate has seen, ascending; never
                                                ///< empty
  bool has_own_held_out = false;                ///< they come from the session's folder held_out/
};

/// Poses every frame and samples those that are fitted, on the session's mesh, with `refine_mesh`
/// as its print says (pipeline/mesh_heights.h). Held out are the session's own held_out/ views
/// where it has them, else the frames that choice.hold_out names. Throws core::Error (bad_input)
/// when no frame is posed, the object is not seen or no view is left to measure on.
Observations observe_session(const std::filesystem::path& folder,
                             const pipeline::FrameChoice& choice, bool refine_mesh, int threads,
                             pipeline::ProgressSink& sink);

/// Integrates all of them: from the samples where those are enough, else the images are read
/// again. `sink` hears of every view.
void integrate_all(const Observations& observations, int threads, fitting::Fitter& fitter,
                   pipeline::ProgressSink& sink);

}  // namespace sheen::evaluation
