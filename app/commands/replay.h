// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "app/commands/command_context.h"
#include "app/commands/replay_options.h"
#include "capture/session/session.h"
#include "capture/source/frame_source.h"

#include <functional>
#include <memory>
#include <string>

namespace sheen::app {

/// What a fit has to say at its end: as JSON and for people.
struct FitOutcome {
  nlohmann::ordered_json document;
  std::string text;
};

/// What a window is told when the frames come from a camera.
struct LiveCamera {
  std::function<void()> on_window_closed;  ///< called on the main thread, may be empty
};

/// Fits `frames` of a session, saves the model and measures it on held-out frames, with
/// options.preview in a window on the calling thread, which must be the main one. `camera` is null
/// for a recording.
FitOutcome fit_session(const ReplayOptions& options, const capture::Session& session,
                       std::unique_ptr<capture::FrameSource> frames, const CommandContext& context,
                       const LiveCamera* camera = nullptr);

/// Fits the recording of the session that the options name. What it lacks, camera, board or mesh,
/// is found from its images first and kept in it; `on_complete` (may be empty) hears when it is
/// there.
FitOutcome fit_recording(const ReplayOptions& options, const CommandContext& context,
                         const std::function<void()>& on_complete = {});

/// `sheen replay SESSION -o MODEL.glb`: a recording becomes a light field.
void add_replay_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
