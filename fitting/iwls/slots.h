// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace sheen::fitting::iwls {

/// Where each of `count` centres stands in memory: quads of four, siblings of the quadtree
/// together. A square whose side is a power of two is stored in Morton order, anything else as it
/// comes.
std::vector<std::size_t> slots_of_centers(std::size_t count);

/// Places for `count` centres, full quads.
inline std::size_t slot_count(std::size_t count) {
  return (count + 3) / 4 * 4;
}

}  // namespace sheen::fitting::iwls
