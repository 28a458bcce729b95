// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

#include <filesystem>

namespace sheen::app {

/// Repeats the paper's experiments on synthetic patches (docs/accuracy.md) and publishes ours
/// beside its figures: tables as text, and one CSV file each in `folder`.
void compare_with_paper(const std::filesystem::path& folder, const CommandContext& context);

}  // namespace sheen::app
