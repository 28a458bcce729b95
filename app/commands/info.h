// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen info PATH`: what a session or a model holds.
void add_info_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
