// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"

#include <filesystem>
#include <optional>

namespace sheen::app {

/// What the comparison of billboards is made on.
struct BillboardComparison {
  std::filesystem::path mesh;  ///< empty: a knot that is made
  int side_px = 256;           ///< of frames and images
};

/// Repeats the experiments on the projection of billboards (docs/systems.md) and publishes ours
/// beside the paper's figures: tables as text, CSV files and charts in `folder`.
void compare_billboards(const BillboardComparison& comparison, const std::filesystem::path& folder,
                        const CommandContext& context);

}  // namespace sheen::app
