// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace sheen::app {

/// Where downloads go on this desktop (XDG_DOWNLOAD_DIR of user-dirs.dirs), else the home folder,
/// else the present one.
std::filesystem::path downloads_folder();

/// What was opened lately, newest first, in $XDG_STATE_HOME/sheen/recent; only what is still there.
std::vector<std::filesystem::path> recent_files();

/// Puts a file before all others that were opened. A list that cannot be written stays as it is.
void note_recent_file(const std::filesystem::path& file);

}  // namespace sheen::app
