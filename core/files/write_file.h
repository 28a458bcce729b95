// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

namespace sheen::core {

/// Writes a whole file beside its final name and moves it into place: afterwards there is the new
/// file or, when it fails, the old one. Throws Error: bad_input when the place cannot be written,
/// run_failed when the disk is full.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sheen::core
