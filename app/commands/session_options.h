// SPDX-License-Identifier: MIT
#pragma once

#include "app/pipeline/frame_statistics.h"
#include "app/pipeline/session_parts.h"
#include "capture/session/session.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>

namespace sheen::app {

/// Which frames of a session a command takes and where their poses come from.
struct SessionOptions {
  std::filesystem::path folder;
  int start = 0;           ///< first frame
  std::optional<int> end;  ///< one past the last frame
  int hold_out = 0;        ///< 0: none
  PoseSource pose_source = PoseSource::automatic;
  capture::PoseGate gate;
};

void add_session_options(CLI::App& command, SessionOptions& options);

/// Poses every chosen frame, without fitting. Throws core::Error (bad_input) when none gets a pose.
std::vector<PosedFrame> pose_frames(const capture::Session& session, const SessionOptions& options,
                                    const std::function<void(int frames_read)>& on_frame);

}  // namespace sheen::app
