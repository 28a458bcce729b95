// SPDX-License-Identifier: MIT
#pragma once

#include "core/image/srgb_curve.h"

#include <algorithm>

namespace sheen::exporters {

/// A display-referred channel as light, limited to [0, 1].
inline float linear_from_srgb(float srgb) {
  return core::linear_from_srgb(std::clamp(srgb, 0.0f, 1.0f));
}

}  // namespace sheen::exporters
