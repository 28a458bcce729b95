// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

void add_view_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
