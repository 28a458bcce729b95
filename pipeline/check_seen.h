// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "pipeline/frame_statistics.h"

namespace sheen::pipeline {

/// A model of nothing helps nobody: throws core::Error (bad_input) with the reasons when no frame
/// was posed or no patch was seen.
void check_something_was_seen(const capture::Session& session, const FrameStatistics& frames,
                              std::size_t samples);

}  // namespace sheen::pipeline
