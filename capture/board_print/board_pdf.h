// SPDX-License-Identifier: MIT
#pragma once

#include "capture/board_print/board_plan.h"

#include <filesystem>

namespace sheen::capture {

/// Writes the sheets of a plan as pages at true scale: tags, a ruler with the words to measure it,
/// marks to cut along where there are several sheets, the board's origin and axes in the free
/// middle. Throws core::Error (run_failed) when the file cannot be written.
void write_board_pdf(const std::filesystem::path& path, const BoardPlan& plan);

}  // namespace sheen::capture
