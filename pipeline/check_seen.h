// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/options.h"
#include "pipeline/session_mesh.h"

namespace sheen::pipeline {

/// A model of nothing helps nobody: throws core::Error (bad_input) when no frame was posed or no
/// patch was seen. Looks which file is at fault: for poses from a file its stamps, for tags a few
/// of the session's images (capture/pose/board_diagnosis.h).
void check_something_was_seen(const capture::Session& session, const FrameChoice& choice,
                              const FrameStatistics& frames, bool patches_were_seen,
                              const SessionScene& scene);

/// The first half of it.
void check_something_was_posed(const capture::Session& session, const FrameChoice& choice,
                               const FrameStatistics& frames);

/// Throws core::Error (bad_input) where the stamps of a pose file name the wrong frames of a
/// recording of `frame_count` frames. Nothing for tags, or where only a part is read.
void check_stamps(const capture::Session& session, const FrameChoice& choice,
                  std::optional<int> frame_count);

/// Where they may name the wrong frames, now that all have been read: one line each.
std::vector<std::string> doubts_of_stamps(const capture::Session& session,
                                          const FrameChoice& choice, const FrameStatistics& frames);

}  // namespace sheen::pipeline
