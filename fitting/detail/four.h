// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/every_processor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace sheen::fitting::detail {

/// Four numbers that are worked on at once, on every processor.
using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using FourCounts = std::uint32_t __attribute__((vector_size(16)));

/// Weights of a triangle's corners at four places on its surface; they add up to 1.
using FourWeights = std::array<Four, 3>;

/// Rounded down; each in [0, 2^31).
SHEEN_INLINE FourCounts as_counts(const Four& numbers) {
  return reinterpret_cast<FourCounts>(__builtin_convertvector(numbers, FourInts));
}

/// Of small numbers; a fraction is dropped.
SHEEN_INLINE FourInts as_ints(const Four& numbers) {
  return __builtin_convertvector(numbers, FourInts);
}

SHEEN_INLINE Four as_four(const FourInts& numbers) {
  return __builtin_convertvector(numbers, Four);
}

SHEEN_INLINE Four load_four(const float* numbers) {
  Four four;
  std::memcpy(&four, numbers, sizeof(four));
  return four;
}

SHEEN_INLINE void store_four(const Four& four, float* numbers) {
  std::memcpy(numbers, &four, sizeof(four));
}

/// The greater ones; those of `b` where a number of `a` is not one.
SHEEN_INLINE Four greater(const Four& a, const Four& b) {
  return a > b ? a : b;
}

/// The square roots of numbers that are not negative.
SHEEN_INLINE Four roots(const Four& x) {
  return Four{__builtin_sqrtf(x[0]), __builtin_sqrtf(x[1]), __builtin_sqrtf(x[2]),
              __builtin_sqrtf(x[3])};
}

/// Bit i is set where the i-th comparison holds.
SHEEN_INLINE unsigned bits_of(const FourInts& holds) {
  const FourInts one = holds & FourInts{1, 2, 4, 8};
  const FourInts two = one | __builtin_shufflevector(one, one, 2, 3, 0, 1);
  const FourInts all = two | __builtin_shufflevector(two, two, 1, 0, 3, 2);
  return static_cast<unsigned>(all[0]);
}

/// The bits of the first of four things, or all.
SHEEN_INLINE unsigned bits_below(std::size_t count) {
  return count < 4 ? (1U << count) - 1 : 15U;
}

/// Calls visit(i) for every bit i that is set.
template <typename Visit>
SHEEN_INLINE void for_bits(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(__builtin_ctz(bits)));
}

/// Four neighbouring bytes, the first in the first place.
SHEEN_INLINE Four four_bytes(const std::uint8_t* bytes) {
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
