// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen survey SESSION -o board.yaml`: where the tags really lie, from the images.
void add_survey_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
