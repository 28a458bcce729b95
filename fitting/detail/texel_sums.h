// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/four.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
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

/// Adds qb times `first` to the first four sums, times `last` to the others. Products are below
/// 2^24 and so exact in floats.
inline void add_products(float qb, const Four& first, const Four& last, TexelSums& texel) {
  static_assert(offsetof(TexelSums, below_left) == sizeof(FourCounts));
  std::array<FourCounts, 2> sums;
  std::memcpy(&sums, &texel, sizeof(sums));
  sums[0] += as_counts(qb * first);
  sums[1] += as_counts(qb * last);
  std::memcpy(static_cast<void*>(&texel), &sums, sizeof(sums));
}

/// Adds a pixel of colour `rgb` (0 to 255 each) that sees the texture at `place` (texels, at least
/// one away from the border) under this cosine. Does nothing where a texel around is full.
inline void add_pixel(const TexelGrid& grid, const Eigen::Vector2f& place, float cosine,
                      const std::array<std::uint32_t, 3>& rgb) {
  // Centres of texels lie at halves.
  constexpr auto steps = static_cast<float>(kPlaceSteps);
  const auto x = static_cast<std::uint32_t>((place.x() - 0.5f) * steps + 0.5f);
  const auto y = static_cast<std::uint32_t>((place.y() - 0.5f) * steps + 0.5f);
  const std::uint32_t right = x % kPlaceSteps;
  const std::uint32_t below = y % kPlaceSteps;
  TexelSums* const upper = grid.texels + (y / kPlaceSteps) * grid.width + x / kPlaceSteps;
  TexelSums* const lower = upper + grid.width;
  if (std::max(std::max(upper[0].weight, upper[1].weight),
               std::max(lower[0].weight, lower[1].weight)) > kFullWeight) {
    return;
  }
  const std::uint32_t b0 = (kPlaceSteps - right) * (kPlaceSteps - below);
  const std::uint32_t b1 = right * (kPlaceSteps - below);
  const std::uint32_t b2 = (kPlaceSteps - right) * below;
  const std::uint32_t b3 = right * below;
  const auto q = static_cast<std::uint32_t>(
      std::max(1.0f, cosine * cosine * static_cast<float>(kCosineUnits) + 0.5f));
  const auto f = [](std::uint32_t v) { return static_cast<float>(v); };
  const float r = f(rgb[0]);
  const float g = f(rgb[1]);
  const float b = f(rgb[2]);
  const Four light{0, r, g, b};
  add_products(f(q * b0), Four{1, f(b1), f(b2), f(b3)}, light, upper[0]);
  add_products(f(q * b1), Four{1, 0, f(b3), 0}, Four{f(b2), r, g, b}, upper[1]);
  add_products(f(q * b2), Four{1, f(b3), 0, 0}, light, lower[0]);
  add_products(f(q * b3), Four{1, 0, 0, 0}, light, lower[1]);
}

}  // namespace sheen::fitting::detail
