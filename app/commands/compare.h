// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen compare SESSION... -o DIR`: every representation on the same observations.
void add_compare_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
