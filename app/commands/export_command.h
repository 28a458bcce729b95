// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// sheen export: a model as a file for other programs.
void add_export_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
