// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen mesh SESSION`: the object's surface from the images themselves.
void add_mesh_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
