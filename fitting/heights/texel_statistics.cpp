// SPDX-License-Identifier: MIT
#include "fitting/heights/texel_statistics.h"

#include <algorithm>

namespace sheen::fitting::heights {

void TexelStatistics::add(const SeenTexel& seen) {
  const float q = seen.weight;
  const float x = seen.slide.x();
  const float y = seen.slide.y();
  weight += q;
  slide[0] += q * x;
  slide[1] += q * y;
  slide_square[0] += q * x * x;
  slide_square[1] += q * x * y;
  slide_square[2] += q * y * y;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const float f = seen.rgb[channel] - 128.0f;
    square += q * f * f;
    colour[channel] += q * f;
    colour_slide[channel][0] += q * f * x;
    colour_slide[channel][1] += q * f * y;
  }
}

float TexelStatistics::scatter() const {
  if (!(weight > 0.0f)) return 0.0f;
  float sum = square;
  for (const float c : colour) sum -= c * c / weight;
  return std::max(0.0f, sum);
}

HeightEquation height_equation(const TexelStatistics& texel,
                               const std::array<Eigen::Vector2f, 3>& gradient) {
  if (!(texel.weight > 0.0f)) return {};
  const float mean_x = texel.slide[0] / texel.weight;
  const float mean_y = texel.slide[1] / texel.weight;
  const float xx = texel.slide_square[0] - texel.slide[0] * mean_x;
  const float xy = texel.slide_square[1] - texel.slide[0] * mean_y;
  const float yy = texel.slide_square[2] - texel.slide[1] * mean_y;
  HeightEquation equation;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const Eigen::Vector2f& g = gradient[channel];
    equation.a += g.x() * g.x() * xx + 2.0f * g.x() * g.y() * xy + g.y() * g.y() * yy;
    equation.b += g.x() * (texel.colour_slide[channel][0] - texel.colour[channel] * mean_x) +
                  g.y() * (texel.colour_slide[channel][1] - texel.colour[channel] * mean_y);
  }
  equation.a = std::max(0.0f, equation.a);
  return equation;
}

std::array<Eigen::Vector2f, 3> mean_gradient(std::span<const TexelStatistics> texels,
                                             const core::Atlas& atlas, std::size_t texel_idx) {
  const auto width = static_cast<std::size_t>(atlas.width);
  const std::size_t column = texel_idx % width;
  const std::size_t row = texel_idx / width;
  const auto along = [&](bool has_before, bool has_after, std::size_t step) {
    const bool before = has_before && texels[texel_idx - step].weight > 0.0f;
    const bool after = has_after && texels[texel_idx + step].weight > 0.0f;
    const TexelStatistics& first = texels[before ? texel_idx - step : texel_idx];
    const TexelStatistics& last = texels[after ? texel_idx + step : texel_idx];
    const float distance = (before ? 1.0f : 0.0f) + (after ? 1.0f : 0.0f);
    std::array<float, 3> slope{};
    for (std::size_t channel = 0; channel < 3 && distance > 0.0f; ++channel) {
      slope[channel] = (last.mean(channel) - first.mean(channel)) / distance;
    }
    return slope;
  };
  const auto x = along(column > 0, column + 1 < width, 1);
  const auto y = along(row > 0, row + 1 < static_cast<std::size_t>(atlas.height), width);
  return {Eigen::Vector2f(x[0], y[0]), {x[1], y[1]}, {x[2], y[2]}};
}

}  // namespace sheen::fitting::heights
