// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/failure.h"
#include "app/batch/session_work.h"
#include "app/commands/command_context.h"

#include <span>

namespace sheen::app {

struct LocalEngine {
  int sessions_at_once = 1;
  Step until = kAllSteps.back();  ///< the last step that is run
};

/// Runs what is missing of every session on this machine, each step as a process of its own. A
/// session that fails stops no other; one that another process works on counts as failed. Throws
/// Interrupted: running steps are ended and their outputs removed, finished ones stand.
Failures run_locally(std::span<const SessionWork> sessions, const LocalEngine& engine,
                     const CommandContext& context);

}  // namespace sheen::app
