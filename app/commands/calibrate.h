// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen calibrate SOURCE -o camera.yaml`: intrinsics and distortion from images of a target.
void add_calibrate_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
