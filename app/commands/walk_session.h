// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "app/commands/command_context.h"
#include "capture/session/session.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <filesystem>
#include <string>

namespace sheen::app {

/// What a walk may come with when its session lacks it.
struct WalkOptions {
  std::filesystem::path camera;  ///< empty: found from the tags
  std::filesystem::path board;   ///< empty: the default sheet, recognised by its ids
};

/// --camera and --board.
void add_walk_options(Command command, WalkOptions& options);

/// What was found on the way, as JSON and for people; both empty where nothing was missing.
struct WalkAnswer {
  nlohmann::ordered_json document;
  std::string text;
};

/// Opens a session. Camera and board that it lacks are taken from the options or found from the
/// tags of its own images, and written into it; what it has stays. Throws core::Error (bad_input)
/// when an option names what the session has already, and when the images do not tell.
capture::Session open_walk(const std::filesystem::path& folder, const WalkOptions& options,
                           const pipeline::FrameChoice& choice, pipeline::ProgressSink& sink,
                           WalkAnswer& answer);

}  // namespace sheen::app
