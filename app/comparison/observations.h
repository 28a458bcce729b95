// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/session_options.h"
#include "core/mesh/neighbours.h"
#include "core/samples/sample_batch.h"

#include <functional>
#include <vector>

namespace sheen::app {

/// What a recording says about its object, worked out once for all candidates.
struct Observations {
  capture::Session session;
  core::Mesh mesh;
  core::VertexNeighbours neighbours;
  std::vector<core::SampleBatch> views;  ///< the samples of each fitted frame, in recorded order
  capture::Session held_out_session;     ///< whose frames `held_out` counts
  std::vector<PosedFrame> held_out;      ///< views no candidate has seen, ascending; never empty
  bool has_own_held_out = false;         ///< they come from the session's folder held_out/
};

/// Poses every frame and samples those that are fitted. Held out are the session's own held_out/
/// views where it has them, else the frames that options.hold_out names. `on_frame` is called after
/// every frame read. Throws core::Error (bad_input) when no frame is posed, the object is not seen
/// or no view is left to measure on.
Observations observe_session(const SessionOptions& options, int threads,
                             const std::function<void(int frames_read)>& on_frame);

}  // namespace sheen::app
