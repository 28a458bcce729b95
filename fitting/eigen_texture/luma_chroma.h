// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace sheen::fitting::eigen_texture {

/// Luma and two chroma differences, in the steps of the image: Y = .299 R + .587 G + .114 B,
/// U = .492 (B - Y), V = .877 (R - Y).
using LumaChroma = std::array<float, 3>;

/// What an error of each counts for when bases are given out.
inline constexpr LumaChroma kChannelWeight{1.0f, 0.35f, 0.35f};

inline LumaChroma luma_chroma(float r, float g, float b) {
  const float y = 0.299f * r + 0.587f * g + 0.114f * b;
  return {y, 0.492f * (b - y), 0.877f * (r - y)};
}

}  // namespace sheen::fitting::eigen_texture
