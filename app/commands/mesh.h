// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"
#include "capture/session/session.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <string>

namespace sheen::app {

/// What is said of a mesh that was measured: as JSON and for people.
struct MeshAnswer {
  nlohmann::ordered_json document;
  std::string text;
};

/// Measures the object of a session that has none and puts it into the session. Throws core::Error
/// (bad_input) when the images do not tell.
MeshAnswer add_measured_mesh(const capture::Session& session, const pipeline::FrameChoice& frames,
                             pipeline::ProgressSink& sink, const CommandContext& context);

/// `sheen mesh SESSION`: the object's surface from the images themselves.
void add_mesh_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
