// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>
#include <vector>

namespace sheen::evaluation {

/// Distinct values of `get(row)` in the order of their appearance.
template <typename Row, typename Get>
auto distinct(std::span<const Row> rows, const Get& get) {
  std::vector<std::decay_t<decltype(get(rows.front()))>> values;
  for (const Row& row : rows) {
    const auto value = get(row);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

}  // namespace sheen::evaluation
