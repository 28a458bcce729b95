// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen evaluate MODEL.glb SESSION`: renders every posed view and compares with its image.
void add_evaluate_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
