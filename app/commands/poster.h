// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"
#include "exporters/viewer/options.h"
#include "fitting/model_file/model_file.h"

namespace sheen::app {

/// Draws the picture that the web viewer's page begins with, where `page.poster` names a file that
/// does not exist: all of the object as the page will show it, transparent around. Throws
/// core::Error.
void draw_missing_poster(const fitting::Model& model, const exporters::viewer::Options& page,
                         const CommandContext& context);

}  // namespace sheen::app
