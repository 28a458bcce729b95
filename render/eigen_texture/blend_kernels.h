// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::render::eigen_texture {

/// Fraction bits of coefficients and of sums, which are grey levels.
inline constexpr int kCoefficientBits = 12;
inline constexpr int kSumBits = 5;
/// Texels handled together: rows of texels are padded to a multiple.
inline constexpr std::size_t kTile = 32;

/// How 8-bit bases lie in memory.
enum class BasisLayout {
  planes,  ///< [basis][texel]
  pairs,   ///< [pair of bases][texel][2]
  tiles    ///< [tile of texels][pair of bases][texel of the tile][2]
};

/// sums[i] = sum_k coefficients[k] basis[k][i], kSumBits fraction bits, saturated. `texels` is a
/// multiple of kTile; with pairs and tiles `bases` is even.
using BlendFunction = void (*)(const std::int8_t* basis, std::size_t bases, std::size_t texels,
                               const std::int16_t* coefficients, std::int16_t* sums);

struct BlendKernel {
  std::string_view name;
  BasisLayout layout;
  BlendFunction blend;
};

/// Those that this processor runs, the quickest first; the last one is portable.
const std::vector<BlendKernel>& blend_kernels();

/// A coefficient with its fraction bits.
std::int16_t fixed_coefficient(float coefficient);

}  // namespace sheen::render::eigen_texture
