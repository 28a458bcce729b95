// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen synth NAME -o SESSION`: a synthetic session with known truth.
void add_synth_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
