// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen replay SESSION -o MODEL.glb`: a recording becomes a light field.
void add_replay_command(CLI::App& program, CommandContext& context);

}  // namespace sheen::app
