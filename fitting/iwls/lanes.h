// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// This header and those that include it are compiled once per instruction set, each time into a
// namespace of its own: an inline function built for AVX2 must never stand in for the portable one.
// For the same reason they use no inline functions of the standard library.
#ifndef SHEEN_LANES
#define SHEEN_LANES portable
#endif
#define SHEEN_INLINE __attribute__((always_inline)) inline

namespace sheen::fitting::iwls::SHEEN_LANES {

/// Four numbers side by side, one for each of four sibling nodes: GCC's vector extension, which any
/// processor can run. Comparisons give a mask of integers, all bits set where true; `mask ? a : b`
/// chooses by lane. Neither fused multiply-add nor reassociation is allowed where they are used, so
/// every instruction set gives the same bits.
template <typename Real>
struct LanesOf;
template <>
struct LanesOf<float> {
  using Type = float __attribute__((vector_size(16)));
  using Mask = std::int32_t __attribute__((vector_size(16)));
};
template <>
struct LanesOf<double> {
  using Type = double __attribute__((vector_size(32)));
  using Mask = std::int64_t __attribute__((vector_size(32)));
};
template <typename Real>
using Lanes = typename LanesOf<Real>::Type;
template <typename Real>
using LaneMask = typename LanesOf<Real>::Mask;

/// One bit per lane.
using LaneBits = unsigned;
inline constexpr LaneBits kAllLanes = 0xF;

template <typename Real>
SHEEN_INLINE Lanes<Real> all_lanes(Real value) {
  return Lanes<Real>{value, value, value, value};
}

template <typename Real>
SHEEN_INLINE Lanes<Real> load(const Real* from) {
  Lanes<Real> value;
  __builtin_memcpy(&value, from, sizeof(value));
  return value;
}

template <typename Real>
SHEEN_INLINE void save(Real* to, Lanes<Real> value) {
  __builtin_memcpy(to, &value, sizeof(value));
}

SHEEN_INLINE LaneBits bits_of(LaneMask<float> mask) {
#if defined(__SSE2__)
  return static_cast<LaneBits>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  return static_cast<LaneBits>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}

SHEEN_INLINE LaneBits bits_of(LaneMask<double> mask) {
  return static_cast<LaneBits>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
}

SHEEN_INLINE Lanes<float> square_root(Lanes<float> x) {
#if defined(__SSE2__)
  return reinterpret_cast<Lanes<float>>(_mm_sqrt_ps(reinterpret_cast<__m128>(x)));
#else
  return Lanes<float>{__builtin_sqrtf(x[0]), __builtin_sqrtf(x[1]), __builtin_sqrtf(x[2]),
                      __builtin_sqrtf(x[3])};
#endif
}

SHEEN_INLINE Lanes<double> square_root(Lanes<double> x) {
  return Lanes<double>{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]),
                       __builtin_sqrt(x[3])};
}

/// Four half floats.
using Halves = std::uint16_t __attribute__((vector_size(8)));

/// Nearest half floats, ties to even, limited to what a half can hold; NaN is not expected.
SHEEN_INLINE Halves to_halves(Lanes<float> value) {
  const Lanes<float> largest = all_lanes(65504.0f);
  value = value > largest ? largest : value;
  value = value < -largest ? -largest : value;
#if defined(__F16C__)
  const __m128i packed = _mm_cvtps_ph(reinterpret_cast<__m128>(value), 0);
  return reinterpret_cast<Halves>(_mm_cvtsi128_si64(packed));
#else
  using Integers = std::uint32_t __attribute__((vector_size(16)));
  const auto bits = reinterpret_cast<Integers>(value);
  const Integers sign = bits & 0x80000000U;
  const Integers size = bits ^ sign;
  // Below 2^-14 the number becomes subnormal: adding 0.5 lets the float unit shift and round.
  const Integers shifted =
      reinterpret_cast<Integers>(reinterpret_cast<Lanes<float>>(size) + 0.5f) - 0x3F000000U;
  // Else move the exponent's origin, round to even and drop 13 bits.
  const Integers rounded = (size - 0x38000000U + 0xFFFU + ((size >> 13) & 1U)) >> 13;
  const Integers half = (size < 0x38800000U ? shifted : rounded) | (sign >> 16);
  return __builtin_convertvector(half, Halves);
#endif
}

SHEEN_INLINE Halves to_halves(Lanes<double> value) {
  const Lanes<double> largest = all_lanes(65504.0);
  value = value > largest ? largest : value;
  value = value < -largest ? -largest : value;
  return to_halves(__builtin_convertvector(value, Lanes<float>));
}

SHEEN_INLINE Lanes<float> from_halves(Halves halves) {
#if defined(__F16C__)
  const auto packed = reinterpret_cast<long long>(halves);
  return reinterpret_cast<Lanes<float>>(_mm_cvtph_ps(_mm_cvtsi64_si128(packed)));
#else
  // Every half held by a model is finite: move the exponent's origin by a multiplication, which
  // takes care of subnormal numbers too.
  using Integers = std::uint32_t __attribute__((vector_size(16)));
  const Integers bits = __builtin_convertvector(halves, Integers);
  const auto scaled = reinterpret_cast<Lanes<float>>((bits & 0x7FFFU) << 13) * 0x1p112f;
  return reinterpret_cast<Lanes<float>>(reinterpret_cast<Integers>(scaled) |
                                        ((bits & 0x8000U) << 16));
#endif
}

}  // namespace sheen::fitting::iwls::SHEEN_LANES
