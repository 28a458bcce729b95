// SPDX-License-Identifier: MIT
#include "core/text/natural_order.h"

#include <algorithm>

namespace sheen::core {
namespace {

/// Takes a number off the beginning, or one letter, and returns it without leading zeros.
std::string_view next_part(std::string_view& text) {
  constexpr std::string_view digits = "0123456789";
  const std::size_t count = std::min(text.find_first_not_of(digits), text.size());
  std::string_view part = text.substr(0, std::max<std::size_t>(count, 1));
  text.remove_prefix(part.size());
  if (count > 0) part.remove_prefix(std::min(part.find_first_not_of('0'), part.size() - 1));
  return part;
}

bool is_number(std::string_view part) {
  return part[0] >= '0' && part[0] <= '9';
}

}  // namespace

bool comes_before(std::string_view a, std::string_view b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const std::string_view x = next_part(rest_a), y = next_part(rest_b);
    if (x == y) continue;
    const bool are_numbers = is_number(x) && is_number(y);
    return are_numbers && x.size() != y.size() ? x.size() < y.size() : x < y;
  }
  return rest_a.empty() != rest_b.empty() ? rest_a.empty() : a < b;
}

}  // namespace sheen::core
