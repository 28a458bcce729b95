// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <optional>

namespace sheen::pipeline {

/// How a camera reads its rows.
struct Readout {
  double readout_s = 0;  ///< as Intrinsics::readout_s
  double sigma_s = 0;    ///< standard deviation of it
};

/// Measures how long a recording's camera takes to read a frame, from three short stretches of its
/// first 240 frames: how tags are bent in a frame against how the camera moves between its
/// neighbours. No value for a global shutter, for recordings that do not tell (a camera at rest,
/// pictures without times, poses from a file), where the motion explains too little, and where
/// another lens explains the tags' corners better.
std::optional<Readout> measure_readout(const capture::Session& session, const FrameChoice& choice);

/// Measures it where the camera file does not say and puts it into the session's camera, with a
/// note.
void complete_readout(capture::Session& session, const FrameChoice& choice, ProgressSink& sink);

}  // namespace sheen::pipeline
