// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace sheen::exporters {

/// sRGB's transfer function: a display-referred channel in [0, 1] as light.
inline float linear_from_srgb(float srgb) {
  const float c = std::clamp(srgb, 0.0f, 1.0f);
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

}  // namespace sheen::exporters
