// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen board -o board.pdf`: a printable board of tags and its board.yaml.
void add_board_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
