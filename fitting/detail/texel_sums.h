// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

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
  const auto add = [&](TexelSums& texel, std::uint32_t qb, std::uint32_t to_right,
                       std::uint32_t to_below, std::uint32_t to_below_right,
                       std::uint32_t to_below_left) {
    texel.weight += qb;
    texel.right += qb * to_right;
    texel.below += qb * to_below;
    texel.below_right += qb * to_below_right;
    texel.below_left += qb * to_below_left;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      texel.colour[channel] += qb * rgb[channel];
    }
  };
  add(upper[0], q * b0, b1, b2, b3, 0);
  add(upper[1], q * b1, 0, b3, 0, b2);
  add(lower[0], q * b2, b3, 0, 0, 0);
  add(lower[1], q * b3, 0, 0, 0, 0);
}

}  // namespace sheen::fitting::detail
