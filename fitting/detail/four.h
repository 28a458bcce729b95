// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>

namespace sheen::fitting::detail {

/// Four numbers that are worked on at once, on every processor.
using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using FourCounts = std::uint32_t __attribute__((vector_size(16)));

/// Rounded down; each in [0, 2^31).
inline FourCounts as_counts(const Four& numbers) {
  return reinterpret_cast<FourCounts>(__builtin_convertvector(numbers, FourInts));
}

/// Four neighbouring bytes, the first in the first place.
inline Four four_bytes(const std::uint8_t* bytes) {
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  using Words = std::uint16_t __attribute__((vector_size(16)));
  std::uint32_t four = 0;
  std::memcpy(&four, bytes, sizeof(four));
  const auto all = reinterpret_cast<Bytes>(FourCounts{four, 0, 0, 0});
  const Bytes words =
      __builtin_shufflevector(all, Bytes{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  const Words ints =
      __builtin_shufflevector(reinterpret_cast<Words>(words), Words{}, 0, 8, 1, 9, 2, 10, 3, 11);
  return __builtin_convertvector(reinterpret_cast<FourInts>(ints), Four);
}

}  // namespace sheen::fitting::detail
