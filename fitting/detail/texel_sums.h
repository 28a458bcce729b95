// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/four.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace sheen::fitting::detail {

/// What the pixels of all views say about one texel: its part of the normal equations
///
///     (sum_p q_p b_p b_p^T) t = sum_p q_p b_p I_p
///
/// of the texture t whose bilinear reading b_p . t is nearest to the pixels' colours I_p, weighted
/// with the squared cosine q_p at which they see the surface. Integers, so that they do not depend
/// on the order of the pixels: the readings' weights b count in 64ths (places in eighths of a
/// texel), q in 16ths, colours in 255ths. The matrix is symmetric and joins a texel with its eight
/// neighbours; each stores its products with those to the right and below. Those with itself
/// follow: the b of a pixel add up to 1, so a row of the matrix adds up to `weight`.
struct alignas(32) TexelSums {
  std::uint32_t weight = 0;               ///< q b
  std::uint32_t right = 0;                ///< q b b'
  std::uint32_t below = 0;                ///< q b b'
  std::uint32_t below_right = 0;          ///< q b b'
  std::uint32_t below_left = 0;           ///< q b b'
  std::array<std::uint32_t, 3> colour{};  ///< q b I, RGB
};
static_assert(sizeof(TexelSums) == 32);

inline constexpr int kPlaceSteps = 8;     ///< of a texel
inline constexpr int kReadingUnits = 64;  ///< a bilinear weight of 1
inline constexpr int kCosineUnits = 16;   ///< a squared cosine of 1

/// A texel whose weight has reached this takes no more, before its colour sums can overflow: after
/// 16,000 pixels that see it frontally.
inline constexpr std::uint32_t kFullWeight = 0xffffffffU / 255U - kCosineUnits * kReadingUnits;

/// A rectangle of texels, row by row.
struct TexelGrid {
  TexelSums* texels;
  std::size_t width;
};

/// Where four pixels read a texture and how much they count, in the units of TexelSums.
struct FourReadings {
  FourInts x, y;  ///< from the first texel's centre
  Four q;
};

/// Places on the texture, texels, at least one away from the border; the cosines are positive.
SHEEN_INLINE FourReadings readings_at(const Four& x, const Four& y, const Four& cosine) {
  // Centres of texels lie at halves.
  constexpr auto steps = static_cast<float>(kPlaceSteps);
  const Four q =
      greater(cosine * cosine * static_cast<float>(kCosineUnits) + 0.5f, Four{1, 1, 1, 1});
  return {as_ints((x - 0.5f) * steps + 0.5f), as_ints((y - 0.5f) * steps + 0.5f),
          as_four(as_ints(q))};
}

/// What a pixel adds to the four texels around its place, left before right, upper before lower: to
/// the first four sums q times `first`, to the others q times `last` times its 1, R, G, B.
struct alignas(64) PixelProducts {
  float first[4][4];
  float last[4][4];
};

/// By the place within the texel: row * kPlaceSteps + column.
inline constexpr auto kPixelProducts = [] {
  std::array<PixelProducts, std::size_t{kPlaceSteps} * kPlaceSteps> products{};
  for (int place = 0; place < kPlaceSteps * kPlaceSteps; ++place) {
    const int right = place % kPlaceSteps;
    const int below = place / kPlaceSteps;
    const auto b0 = static_cast<float>((kPlaceSteps - right) * (kPlaceSteps - below));
    const auto b1 = static_cast<float>(right * (kPlaceSteps - below));
    const auto b2 = static_cast<float>((kPlaceSteps - right) * below);
    const auto b3 = static_cast<float>(right * below);
    products[static_cast<std::size_t>(place)] = {
        {{b0, b0 * b1, b0 * b2, b0 * b3}, {b1, 0, b1 * b3, 0}, {b2, b2 * b3, 0, 0}, {b3, 0, 0, 0}},
        {{0, b0, b0, b0}, {b1 * b2, b1, b1, b1}, {0, b2, b2, b2}, {0, b3, b3, b3}}};
  }
  return products;
}();

/// Adds pixel `i` of `readings`, of colour `one_rgb` (1, and whole numbers from 0 to 255). Does
/// nothing where a texel around is full. Products are below 2^24 and so exact in floats.
SHEEN_INLINE void add_pixel(const TexelGrid& grid, const FourReadings& readings, std::size_t i,
                            const Four& one_rgb) {
  static_assert(offsetof(TexelSums, below_left) == sizeof(FourCounts));
  const auto x = static_cast<std::size_t>(readings.x[i]);
  const auto y = static_cast<std::size_t>(readings.y[i]);
  TexelSums* const upper = grid.texels + (y / kPlaceSteps) * grid.width + x / kPlaceSteps;
  TexelSums* const lower = upper + grid.width;
  if (std::max(std::max(upper[0].weight, upper[1].weight),
               std::max(lower[0].weight, lower[1].weight)) > kFullWeight) {
    return;
  }
  const PixelProducts& products = kPixelProducts[(y % kPlaceSteps) * kPlaceSteps + x % kPlaceSteps];
  const Four light = readings.q[i] * one_rgb;
  const auto add = [&](std::size_t corner, TexelSums& texel) {
    std::array<FourCounts, 2> sums;
    std::memcpy(&sums, &texel, sizeof(sums));
    sums[0] += as_counts(readings.q[i] * load_four(products.first[corner]));
    sums[1] += as_counts(light * load_four(products.last[corner]));
    std::memcpy(static_cast<void*>(&texel), &sums, sizeof(sums));
  };
  add(0, upper[0]);
  add(1, upper[1]);
  add(2, lower[0]);
  add(3, lower[1]);
}

}  // namespace sheen::fitting::detail
