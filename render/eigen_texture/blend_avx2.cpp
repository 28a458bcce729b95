// SPDX-License-Identifier: MIT
#include "render/eigen_texture/blend_kernels.h"

#include <immintrin.h>

namespace sheen::render::eigen_texture {
namespace {

/// The second scheme with a tile's sums in registers until all bases are added.
void tiles(const std::int8_t* basis, std::size_t bases, std::size_t texels,
           const std::int16_t* coefficients, std::int16_t* sums) {
  constexpr int shift = kCoefficientBits - kSumBits;
  static_assert(kTile == 32);
  const __m256i half = _mm256_set1_epi32(1 << (shift - 1));
  for (std::size_t tile = 0; tile < texels / kTile; ++tile) {
    __m256i sum0 = half, sum1 = half, sum2 = half, sum3 = half;
    for (std::size_t k = 0; k < bases; k += 2) {
      const auto low = static_cast<std::uint16_t>(coefficients[k]);
      const auto high = static_cast<std::uint32_t>(static_cast<std::uint16_t>(coefficients[k + 1]));
      const __m256i coefficient = _mm256_set1_epi32(static_cast<int>(high << 16 | low));
      const auto* const pair = reinterpret_cast<const __m128i*>(basis) + 4 * (k / 2);
      const auto product = [&](int part) {
        return _mm256_madd_epi16(_mm256_cvtepi8_epi16(_mm_loadu_si128(pair + part)), coefficient);
      };
      sum0 = _mm256_add_epi32(sum0, product(0));
      sum1 = _mm256_add_epi32(sum1, product(1));
      sum2 = _mm256_add_epi32(sum2, product(2));
      sum3 = _mm256_add_epi32(sum3, product(3));
    }
    // Packing works within halves of a register; the permutation puts them back in order.
    const auto packed = [](__m256i first, __m256i second) {
      const __m256i mixed =
          _mm256_packs_epi32(_mm256_srai_epi32(first, shift), _mm256_srai_epi32(second, shift));
      return _mm256_permute4x64_epi64(mixed, 0b11011000);
    };
    auto* const to = reinterpret_cast<__m256i*>(sums + tile * kTile);
    _mm256_storeu_si256(to, packed(sum0, sum1));
    _mm256_storeu_si256(to + 1, packed(sum2, sum3));
    basis += bases * kTile;
  }
}

}  // namespace

BlendKernel tile_kernel();
BlendKernel tile_kernel() {
  return {"tiles", BasisLayout::tiles, tiles};
}

}  // namespace sheen::render::eigen_texture
