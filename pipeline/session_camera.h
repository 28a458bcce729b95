// SPDX-License-Identifier: MIT
#pragma once

#include "capture/board_print/default_board.h"
#include "capture/session/session.h"
#include "capture/walk_calibration/walk_calibration.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <filesystem>
#include <optional>

namespace sheen::pipeline {

/// What a walk's tags say that its session does not.
struct WalkFindings {
  std::optional<capture::DefaultSheet> sheet;  ///< recognised; nothing where a board was given
  capture::Board board;
  /// Nothing where the session has its camera.
  std::optional<capture::WalkCalibration> calibration;
  int frames_read = 0;
};

/// Reads the frames of `choice` once for their tags: recognises the default sheet where the session
/// has no board, calibrates the camera where it has none. Held-out frames take part: only their
/// tags are looked at, never the object. Throws core::Error (bad_input) when the first image shows
/// another board's tags, when too few images show tags, and when they do not tell the camera.
WalkFindings read_walk(const capture::Session& session, const FrameChoice& choice,
                       ProgressSink& sink);

}  // namespace sheen::pipeline
