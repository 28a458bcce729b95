// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

namespace sheen::app {

/// `sheen resume`: a fit state goes on with another session.
void add_resume_command(CommandLine& program, CommandContext& context);

}  // namespace sheen::app
