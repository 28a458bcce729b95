// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "pipeline/options.h"

namespace sheen::app {

/// Which frames of a session are taken and where their poses come from: the same words for every
/// command.
void add_frame_options(Command command, pipeline::FrameChoice& choice);

/// The same, and --hold-out: for commands that compare a model with what it was not fitted to.
void add_evaluated_frame_options(Command command, pipeline::FrameChoice& choice);

}  // namespace sheen::app
