// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen merge`: fit states joined into one model.
void add_merge_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
