// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/luma_chroma.h"
#include "fitting/eigen_texture/texel_reader.h"
#include "fitting/texture/surface_texture.h"

namespace sheen::fitting::eigen_texture {

/// Between two colours, R, G, B in the steps of the image.
inline LumaChroma deviation(const Texel& colour, const Texel& mean) {
  const auto channel = [&](std::size_t c) {
    return static_cast<float>(colour[c]) - static_cast<float>(mean[c]);
  };
  return luma_chroma(channel(0), channel(1), channel(2));
}

/// Texels from which coefficients are found: their noise counts for sqrt(bases / seen texels).
inline constexpr std::size_t kSampledTexels = 4096;
/// Every so many texels are that many.
inline std::size_t sampling_step(std::size_t texels) {
  return texels < kSampledTexels ? 1 : texels / kSampledTexels;
}

}  // namespace sheen::fitting::eigen_texture
