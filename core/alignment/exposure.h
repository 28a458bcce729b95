// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

namespace sheen::core {

/// Which pairs speak for an exposure.
struct ExposureLimits {
  float darkest = 0.08f;        ///< luma below this is noise and black level
  float brightest = 0.92f;      ///< luma above this is clipped or nearly so
  std::size_t min_pairs = 200;  ///< fewer give no answer, >= 1
  double largest_change = 1.5;  ///< a gain outside [1 / this, this] gives no answer, > 1
};

/// Gain of an image against the model: the median of `measured[i] / predicted[i]` (luma of
/// display-referred sRGB, [0, 1]) over the pairs that are well exposed on both sides. Under a power
/// law for display a change of exposure is such a factor. `ratios` is scratch space.
std::optional<double> estimate_gain(const std::vector<float>& measured,
                                    const std::vector<float>& predicted,
                                    const ExposureLimits& limits, std::vector<double>& ratios);

}  // namespace sheen::core
