// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen batch`: every step over many sessions.
void add_batch_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
