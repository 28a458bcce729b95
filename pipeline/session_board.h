// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board_refinement.h"
#include "capture/session/session.h"
#include "pipeline/progress_sink.h"

#include <optional>

namespace sheen::pipeline {

/// Reads the frames [start, end) of a session once for their tags and refines the board from them;
/// at most a few hundred, spread evenly. Held-out frames take part: only their tags are looked at,
/// never the object. Nothing when the tags do not tell. Throws core::Error (bad_input) for a
/// session without a board, and for one whose ids are not those of the print.
std::optional<capture::BoardRefinement> refine_session_board(
    const capture::Session& session, int start, std::optional<int> end, ProgressSink& sink,
    capture::LensRefinement lens = capture::LensRefinement::off);

}  // namespace sheen::pipeline
