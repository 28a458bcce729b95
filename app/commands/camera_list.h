// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen capture --list`: the machine's cameras with modes and controls.
void list_cameras(const CommandContext& context);

}  // namespace sheen::app
