// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/stored_channel.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::eigen_texture {

Channel stored(const Factors& factors) {
  constexpr float steps = 127.0f;
  const auto bases = static_cast<std::size_t>(factors.rank());
  const auto texels = static_cast<std::size_t>(factors.basis.rows());
  const auto views = static_cast<std::size_t>(factors.coefficients.rows());
  Channel channel{bases, std::vector<std::int8_t>(bases * texels),
                  std::vector<Eigen::half>(bases * views)};
  for (std::size_t k = 0; k < bases; ++k) {
    const auto basis = factors.basis.col(static_cast<Eigen::Index>(k));
    const float most = texels > 0 ? basis.cwiseAbs().maxCoeff() : 0.0f;
    const float step = most > 0 ? most / steps : 1.0f;
    std::int8_t* const row = channel.texels.data() + k * texels;
    for (std::size_t i = 0; i < texels; ++i) {
      row[i] = static_cast<std::int8_t>(std::lround(basis[static_cast<Eigen::Index>(i)] / step));
    }
    for (std::size_t v = 0; v < views; ++v) {
      const float coefficient =
          step * factors.coefficients(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(k));
      channel.coefficients[v * bases + k] =
          Eigen::half(std::clamp(coefficient, -kMostCoefficient, kMostCoefficient));
    }
  }
  return channel;
}

}  // namespace sheen::fitting::eigen_texture
