// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sheen::capture::synthetic {

/// Integer hash with low bias (Wellons' "lowbias32"): the source of every random number of the
/// synthetic scenes, so that a value depends on its place and never on the order of the work.
constexpr std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

template <typename... Rest>
constexpr std::uint32_t hash(std::uint32_t first, Rest... rest) {
  return hash(first ^ (hash(static_cast<std::uint32_t>(rest)...) + 0x9e3779b9U));
}

/// Upper 24 bits as a number in [0, 1).
constexpr float unit_float(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

}  // namespace sheen::capture::synthetic
