// SPDX-License-Identifier: MIT
#pragma once

#include "render/eigen_texture/blend_kernels.h"

#include <algorithm>
#include <array>

namespace sheen::render::eigen_texture {

/// The plain loop: what every other kernel computes. Static, because measurements compile it
/// without vectors, too.
static inline void blend_plainly(const std::int8_t* basis, std::size_t bases, std::size_t texels,
                                 const std::int16_t* coefficients, std::int16_t* sums) {
  constexpr std::size_t strip = 1024;  // stays in the cache
  constexpr int shift = kCoefficientBits - kSumBits;
  std::array<std::int32_t, strip> exact;
  for (std::size_t begin = 0; begin < texels; begin += strip) {
    const std::size_t count = std::min(strip, texels - begin);
    exact.fill(1 << (shift - 1));
    for (std::size_t k = 0; k < bases; ++k) {
      const std::int8_t* const row = basis + k * texels + begin;
      const std::int32_t coefficient = coefficients[k];
      for (std::size_t i = 0; i < count; ++i) exact[i] += coefficient * row[i];
    }
    for (std::size_t i = 0; i < count; ++i) {
      sums[begin + i] = static_cast<std::int16_t>(std::clamp(exact[i] >> shift, -32768, 32767));
    }
  }
}

}  // namespace sheen::render::eigen_texture
