// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen render MODEL.glb --views SESSION -o DIR`: images from every view of a session.
void add_render_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
