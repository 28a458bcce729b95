// SPDX-License-Identifier: MIT
#include "capture/files/text_file.h"

#include "core/diagnostics/error.h"
#include "core/text/text_form.h"

#include <fstream>
#include <system_error>

namespace sheen::capture {

std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code no_throw;
  if (std::filesystem::is_directory(path, no_throw)) {
    throw core::bad_input(path, "is a folder, not a file", "name the file in it");
  }
  if (!std::filesystem::is_regular_file(path, no_throw)) {
    throw core::bad_input(path, "there is no such file", "check the path");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw core::bad_input(path, "cannot be opened", "check its permissions");
  const auto bytes = std::filesystem::file_size(path, no_throw);
  if (no_throw || bytes > max_bytes) {
    throw core::bad_input(path, "is larger than " + std::to_string(max_bytes) + " bytes",
                          "check that it is the file you mean");
  }
  std::string text(static_cast<std::size_t>(bytes), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (static_cast<std::size_t>(in.gcount()) != text.size()) {
    throw core::bad_input(path, "cannot be read to its end", "check the disk");
  }
  core::normalise_text(text, path);
  return text;
}

}  // namespace sheen::capture
