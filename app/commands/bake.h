// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen bake`: billboards of a finished model, or of a mesh with coloured vertices.
void add_bake_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
