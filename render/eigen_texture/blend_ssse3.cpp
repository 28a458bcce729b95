// SPDX-License-Identifier: MIT
// The two schemes of the paper with registers of 16 bytes instead of MMX's 8.
#include "render/eigen_texture/blend_kernels.h"

#include <tmmintrin.h>

#include <algorithm>
#include <array>

namespace sheen::render::eigen_texture {
namespace {

constexpr std::size_t kStrip = 2048;  // texels whose sums stay in the cache

__m128i load(const void* from) {
  return _mm_loadu_si128(static_cast<const __m128i*>(from));
}
void store(void* to, __m128i value) {
  _mm_storeu_si128(static_cast<__m128i*>(to), value);
}

/// Scheme 1: one basis per sweep; multiply high, rounded (without rounding every term would lose
/// half a step on average), and add with saturation, 8 texels at once.
void multiply_high(const std::int8_t* basis, std::size_t bases, std::size_t texels,
                   const std::int16_t* coefficients, std::int16_t* sums) {
  // (b << 8) c >> 15 has 8 + kCoefficientBits - 15 fraction bits.
  static_assert(8 + kCoefficientBits - 15 == kSumBits);
  const __m128i zero = _mm_setzero_si128();
  for (std::size_t begin = 0; begin < texels; begin += kStrip) {
    const std::size_t end = std::min(texels, begin + kStrip);
    std::fill(sums + begin, sums + end, std::int16_t{0});
    for (std::size_t k = 0; k < bases; ++k) {
      const __m128i coefficient = _mm_set1_epi16(coefficients[k]);
      const std::int8_t* const row = basis + k * texels;
      for (std::size_t i = begin; i < end; i += 16) {
        const __m128i both = load(row + i);
        const __m128i first = _mm_mulhrs_epi16(_mm_unpacklo_epi8(zero, both), coefficient);
        const __m128i second = _mm_mulhrs_epi16(_mm_unpackhi_epi8(zero, both), coefficient);
        store(sums + i, _mm_adds_epi16(load(sums + i), first));
        store(sums + i + 8, _mm_adds_epi16(load(sums + i + 8), second));
      }
    }
  }
}

/// Scheme 2: two bases per sweep, interleaved, so that one multiply-add gives b c + b' c'.
void multiply_add(const std::int8_t* basis, std::size_t bases, std::size_t texels,
                  const std::int16_t* coefficients, std::int16_t* sums) {
  constexpr int shift = kCoefficientBits - kSumBits;
  constexpr std::size_t strip = kStrip / 2;
  const __m128i half = _mm_set1_epi32(1 << (shift - 1));
  std::array<std::int32_t, strip> exact;
  for (std::size_t begin = 0; begin < texels; begin += strip) {
    const std::size_t count = std::min(strip, texels - begin);
    exact.fill(0);
    for (std::size_t k = 0; k < bases; k += 2) {
      const auto low = static_cast<std::uint16_t>(coefficients[k]);
      const auto high = static_cast<std::uint32_t>(static_cast<std::uint16_t>(coefficients[k + 1]));
      const __m128i coefficient = _mm_set1_epi32(static_cast<int>(high << 16 | low));
      const std::int8_t* const row = basis + k * texels + 2 * begin;
      for (std::size_t i = 0; i < count; i += 8) {
        const __m128i both = load(row + 2 * i);
        const __m128i sign = _mm_cmpgt_epi8(_mm_setzero_si128(), both);
        const __m128i first = _mm_madd_epi16(_mm_unpacklo_epi8(both, sign), coefficient);
        const __m128i second = _mm_madd_epi16(_mm_unpackhi_epi8(both, sign), coefficient);
        store(exact.data() + i, _mm_add_epi32(load(exact.data() + i), first));
        store(exact.data() + i + 4, _mm_add_epi32(load(exact.data() + i + 4), second));
      }
    }
    for (std::size_t i = 0; i < count; i += 8) {
      const __m128i first = _mm_srai_epi32(_mm_add_epi32(load(exact.data() + i), half), shift);
      const __m128i second = _mm_srai_epi32(_mm_add_epi32(load(exact.data() + i + 4), half), shift);
      store(sums + begin + i, _mm_packs_epi32(first, second));
    }
  }
}

}  // namespace

BlendKernel multiply_high_kernel();
BlendKernel multiply_high_kernel() {
  return {"multiply-high", BasisLayout::planes, multiply_high};
}
BlendKernel multiply_add_kernel();
BlendKernel multiply_add_kernel() {
  return {"multiply-add", BasisLayout::pairs, multiply_add};
}

}  // namespace sheen::render::eigen_texture
