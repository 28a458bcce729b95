// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/error.h"

#include <filesystem>
#include <optional>

namespace sheen::capture {

/// Whether a recording that ended after `decoded` frames, the last at `last_slot` frame times after
/// the first, lacks some of the `promised` ones: more than one frame and more than two frame times.
/// Containers over-state by a frame, and state frames of even spacing where a recording has gaps,
/// so being short by one of the two only is no fault.
bool is_short(std::optional<int> promised, int decoded, double last_slot);

/// What to throw for it.
core::Error early_end(const std::filesystem::path& path, int decoded, std::optional<int> promised);

}  // namespace sheen::capture
