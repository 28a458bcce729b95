// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace sheen::core {

/// sRGB's transfer function (IEC 61966-2-1): a display-referred channel >= 0 as light.
inline float linear_from_srgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

/// Its inverse.
inline float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

}  // namespace sheen::core
