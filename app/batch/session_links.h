// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sheen::app {

/// Makes `to` a session folder that holds what `from` holds, by links, but for the file `replaced`
/// (relative to it), which is left to be written. What such a folder holds itself is copied, so
/// that a chain of them needs none but its last and the recording. Throws
/// std::filesystem::filesystem_error.
void link_session(const std::filesystem::path& from, const std::filesystem::path& to,
                  const std::filesystem::path& replaced);

}  // namespace sheen::app
