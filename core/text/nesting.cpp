// SPDX-License-Identifier: MIT
#include "core/text/nesting.h"

#include <algorithm>

namespace sheen::core {
namespace {

struct Brackets {
  std::size_t depth = 0, deepest = 0;

  void see(char c) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if ((c == ']' || c == '}') && depth > 0) --depth;
  }
};

}  // namespace

std::size_t bracket_depth(std::string_view text) {
  Brackets brackets;
  for (const char c : text) brackets.see(c);
  return brackets.deepest;
}

std::size_t json_depth(std::string_view text) {
  Brackets brackets;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      is_in_string = !is_in_string;
    } else if (!is_in_string) {
      brackets.see(text[i]);
    } else if (text[i] == '\\') {
      ++i;
    }
  }
  return brackets.deepest;
}

}  // namespace sheen::core
