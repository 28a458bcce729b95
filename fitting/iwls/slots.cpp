// SPDX-License-Identifier: MIT
#include "fitting/iwls/slots.h"

#include <numeric>

namespace sheen::fitting::iwls {
namespace {

// Interleaves the bits of x and y, those of x below.
std::size_t morton(std::size_t x, std::size_t y) {
  std::size_t code = 0;
  for (std::size_t bit = 0; (x >> bit) != 0 || (y >> bit) != 0; ++bit) {
    code |= ((x >> bit) & 1) << (2 * bit) | ((y >> bit) & 1) << (2 * bit + 1);
  }
  return code;
}

}  // namespace

std::vector<std::size_t> slots_of_centers(std::size_t count) {
  std::vector<std::size_t> slots(count);
  std::iota(slots.begin(), slots.end(), std::size_t{0});
  std::size_t side = 1;
  while (side * side < count) side *= 2;
  if (side * side != count) return slots;
  for (std::size_t i = 0; i < count; ++i) slots[i] = morton(i % side, i / side);
  return slots;
}

}  // namespace sheen::fitting::iwls
