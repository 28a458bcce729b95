// SPDX-License-Identifier: MIT
#include "core/text/text_form.h"

#include "core/diagnostics/error.h"

namespace sheen::core {
namespace {

/// Windows writes UTF-16 with a mark; without one, text of that form has zeros between its letters.
bool is_utf16(const std::string& text) {
  if (text.size() < 4) return false;
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) return true;
  const auto zero_at = [&text](std::size_t i) { return text[i] == '\0'; };
  return (zero_at(1) && zero_at(3) && !zero_at(0) && !zero_at(2)) ||
         (zero_at(0) && zero_at(2) && !zero_at(1) && !zero_at(3));
}

}  // namespace

void normalise_text(std::string& text, const std::filesystem::path& path) {
  if (is_utf16(text)) {
    throw bad_input(path, "is written in UTF-16", "save it as UTF-8 or plain text");
  }
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  if (text.find('\r') == std::string::npos) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') {
      text[kept++] = text[i];
    } else if (i + 1 == text.size() || text[i + 1] != '\n') {
      text[kept++] = '\n';
    }
  }
  text.resize(kept);
}

}  // namespace sheen::core
