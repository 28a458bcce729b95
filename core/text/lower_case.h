// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sheen::core {

/// `text` with the letters A to Z in lower case, whatever the locale.
inline std::string lower_case(std::string text) {
  for (char& letter : text) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return text;
}

}  // namespace sheen::core
