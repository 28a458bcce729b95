// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace sheen::core {

/// JSON as it may stand inside a script element of a page: no tag can begin in it.
inline std::string in_script(std::string_view json) {
  std::string safe;
  for (const char character : json) {
    if (character == '<') {
      safe += "\\u003c";
    } else {
      safe += character;
    }
  }
  return safe;
}

}  // namespace sheen::core
