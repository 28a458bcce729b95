// SPDX-License-Identifier: MIT
#include "core/files/read_file.h"

#include "core/diagnostics/error.h"

#include <fstream>
#include <system_error>

namespace sheen::core {

std::string read_file(const std::filesystem::path& path, std::size_t most_bytes) {
  std::error_code no_throw;
  if (std::filesystem::is_directory(path, no_throw)) {
    throw bad_input(path, "is a folder, not a file", "name the file in it");
  }
  if (!std::filesystem::is_regular_file(path, no_throw)) {
    throw bad_input(path, "there is no such file", "check the path");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw bad_input(path, "cannot be opened", "check its permissions");
  const auto size = std::filesystem::file_size(path, no_throw);
  if (no_throw || size > most_bytes) {
    throw bad_input(path, "is larger than " + std::to_string(most_bytes) + " bytes",
                    "check that it is the file you mean");
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::size_t>(in.gcount()) != bytes.size()) {
    throw bad_input(path, "cannot be read to its end", "check the disk");
  }
  return bytes;
}

}  // namespace sheen::core
