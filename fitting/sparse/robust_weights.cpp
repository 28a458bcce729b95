// SPDX-License-Identifier: MIT
#include "fitting/sparse/robust_weights.h"

#include "fitting/sparse/sample_store.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace sheen::fitting::sparse {

bool robust_factors(std::span<float> residuals, float floor) {
  constexpr float deviations_per_median = 1.4826f;
  constexpr float deviations = 5.0f;
  assert(!residuals.empty() && residuals.size() <= kMaxStoredSamples);
  // Find the scale.
  std::array<float, kMaxStoredSamples> sorted;
  const auto end = std::copy(residuals.begin(), residuals.end(), sorted.begin());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(sorted.begin(), middle, end);
  const float threshold = deviations * std::max(floor, deviations_per_median * *middle);
  // Weigh.
  bool any = false;
  for (float& value : residuals) {
    any |= value > threshold;
    const float excess = std::max(1.0f, value / threshold);
    value = 1.0f / (excess * excess);
  }
  return any;
}

}  // namespace sheen::fitting::sparse
