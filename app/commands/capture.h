// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/capture_options.h"
#include "app/commands/command_context.h"
#include "capture/source/camera.h"

#include <memory>

namespace sheen::app {

/// `sheen capture DEVICE -o SESSION`: records a session and fits it meanwhile.
void add_capture_command(CommandLine& program, CommandContext& context);

/// Records `camera` as the options say and fits every recorded image; those that the fit had no
/// time for follow at the end, so that the model is that of a replay of the recording. Publishes
/// what came of it. A camera or a disk that fails ends the recording, not the fit. Throws
/// core::Error.
void capture_session(std::unique_ptr<capture::Camera> camera, const CaptureOptions& options,
                     const CommandContext& context);

}  // namespace sheen::app
