// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace sheen::core {

/// The bytes of a file of at most `most_bytes`. Throws Error (bad_input) for what is no file (a
/// pipe would be waited for for ever), larger, or not readable to its end.
std::string read_file(const std::filesystem::path& path,
                      std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace sheen::core
