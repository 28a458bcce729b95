// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/pose_estimator.h"
#include "capture/session/session.h"
#include "pipeline/options.h"

#include <memory>
#include <optional>

namespace sheen::pipeline {

/// Whether `source` means the session's poses.txt and not its tags.
bool takes_poses_from_file(const capture::Session& session, PoseSource source);

/// The board whose tags give the poses; nothing where a file does.
std::optional<capture::Board> tag_board(const capture::Session& session, PoseSource source);

/// Throws core::Error (bad_input) when the session lacks what `source` asks for. `board` replaces
/// the session's own when it is not null.
std::unique_ptr<capture::PoseEstimator> make_pose_estimator(const capture::Session& session,
                                                            PoseSource source,
                                                            const capture::PoseGate& gate,
                                                            const capture::Board* board = nullptr);

}  // namespace sheen::pipeline
