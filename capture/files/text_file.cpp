// SPDX-License-Identifier: MIT
#include "capture/files/text_file.h"

#include "core/files/read_file.h"
#include "core/text/text_form.h"

namespace sheen::capture {

std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::string text = core::read_file(path, max_bytes);
  core::normalise_text(text, path);
  return text;
}

}  // namespace sheen::capture
