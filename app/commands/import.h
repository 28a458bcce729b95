// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen import DATASET --mesh FILE -o SESSION`: posed images of another program as a session.
void add_import_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
