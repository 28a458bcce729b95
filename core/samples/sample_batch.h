// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// What one view says about the surface: at most one sample per patch, patches ascending.
/// Structure of arrays, all of the same length.
struct SampleBatch {
  std::vector<std::uint32_t> patch;
  std::vector<float> u, v;     ///< view direction on the unit disc (eq. 3)
  std::vector<float> r, g, b;  ///< display-referred sRGB in [0, 1]

  [[nodiscard]] std::size_t size() const { return patch.size(); }
  void clear() {
    patch.clear();
    for (auto* column : {&u, &v, &r, &g, &b}) column->clear();
  }
};

}  // namespace sheen::core
