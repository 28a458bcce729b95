// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "fitting/heights/seen_texels.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sheen::fitting::heights {

/// What views showed at a texel: sums, weighted with q, of colours f (RGB less mid grey, which
/// keeps the sums small) and of the slides o of SeenTexel.
struct alignas(64) TexelStatistics {
  float weight = 0;                                    ///< q
  float square = 0;                                    ///< q |f|^2
  std::array<float, 3> colour{};                       ///< q f
  std::array<float, 2> slide{};                        ///< q o
  std::array<float, 3> slide_square{};                 ///< q o o^T: xx, xy, yy
  std::array<std::array<float, 2>, 3> colour_slide{};  ///< q f o, channel by channel

  void add(const SeenTexel& seen);
  [[nodiscard]] float mean(std::size_t channel) const { return colour[channel] / weight; }
  /// Sum of q |f - mean|^2 over the channels.
  [[nodiscard]] float scatter() const;
};

/// The normal equation a h = b of a height h at one texel: from the views' differences to the mean
/// colour, explained as a slide along the mean picture's gradient.
struct HeightEquation {
  float a = 0, b = 0;
};

/// The equation of a texel. A view's colour is T(x + o h) = T(x) + h g . o for the texture T and
/// its gradient g (channel by channel, per texel); T(x) is unknown and taken out of the least
/// squares, which leaves deviations from the means of f and o.
HeightEquation height_equation(const TexelStatistics& texel,
                               const std::array<Eigen::Vector2f, 3>& gradient);

/// Gradient of the mean picture at a texel, one channel after the other, by differences to
/// neighbours that were seen; zero where there are none.
std::array<Eigen::Vector2f, 3> mean_gradient(std::span<const TexelStatistics> texels,
                                             const core::Atlas& atlas, std::size_t texel_idx);

}  // namespace sheen::fitting::heights
