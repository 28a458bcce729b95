// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sheen::app {

/// `sheen` without arguments: the start window until it is closed. False, at once, where there is
/// no display or this build has no windows. Snapshots (F12) go to `snapshot_folder`.
bool run_start(const std::filesystem::path& snapshot_folder);

}  // namespace sheen::app
