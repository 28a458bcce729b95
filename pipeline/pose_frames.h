// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <vector>

namespace sheen::pipeline {

/// Poses every chosen frame, without fitting: with a `hold_out` those that a fit leaves out. Throws
/// core::Error (bad_input) when none gets a pose, or when the board's ids are not those of the
/// print.
std::vector<PosedFrame> pose_frames(const capture::Session& session, const FrameChoice& choice,
                                    ProgressSink& sink);

}  // namespace sheen::pipeline
