// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen register SESSION`: where the mesh stands on the board, from the images.
void add_register_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
