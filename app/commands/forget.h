// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen forget`: views taken out of a fit state.
void add_forget_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
