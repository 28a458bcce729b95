// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace sheen::core {

/// Bits of a float, the same for -0 and 0.
inline std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value + 0.0f);
}

/// Hash of the bits of `size` floats, for tables of what is exactly equal.
template <std::size_t size>
struct BitKeyHash {
  std::size_t operator()(const std::array<std::uint32_t, size>& key) const {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const std::uint32_t word : key) hash = std::rotl((hash ^ word) * 0xff51afd7ed558ccdu, 29);
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace sheen::core
