// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace sheen::core {

/// Deeper than any camera or board file nests its brackets.
inline constexpr std::size_t kMostBracketDepth = 60;

/// How deep brackets nest, those in quotes and comments included: for texts whose form is not yet
/// known (YAML, JSON, XML). Parsers recurse, and take 200 bytes and more for every bracket.
inline std::size_t bracket_depth(std::string_view text) {
  std::size_t depth = 0;
  std::size_t deepest = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if ((c == ']' || c == '}') && depth > 0) --depth;
  }
  return deepest;
}

}  // namespace sheen::core
