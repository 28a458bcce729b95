// SPDX-License-Identifier: MIT
#include "fitting/sparse/robust_weights.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace sheen::fitting::sparse {

float suspect_threshold(std::span<const float> residuals, float floor) {
  constexpr float deviations_per_median = 1.4826f;
  constexpr float deviations = 5.0f;
  assert(!residuals.empty() && residuals.size() <= kMaxStoredSamples);
  std::array<float, kMaxStoredSamples> sorted{};
  const auto end = std::copy(residuals.begin(), residuals.end(), sorted.begin());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(sorted.begin(), middle, end);
  return deviations * std::max(floor, deviations_per_median * *middle);
}

float robust_factor(float residual, float threshold) {
  const float excess = std::max(1.0f, residual / threshold);
  return 1.0f / (excess * excess);
}

float residual_around(std::span<const DirectedColour> samples, std::span<const float> residuals,
                      std::size_t sample_idx) {
  // List the others by distance.
  constexpr std::size_t neighbours = 7;
  std::array<std::pair<float, float>, kMaxStoredSamples> others;  // squared distance, residual
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == sample_idx) continue;
    others[count++] = {(samples[i].uv - samples[sample_idx].uv).squaredNorm(), residuals[i]};
  }
  if (count == 0) return 0.0f;
  const auto near = static_cast<std::ptrdiff_t>(std::min(neighbours, count));
  std::partial_sort(others.begin(), others.begin() + near,
                    others.begin() + static_cast<std::ptrdiff_t>(count));
  // Take the median of the nearest.
  const auto by_residual = [](const auto& a, const auto& b) { return a.second < b.second; };
  std::nth_element(others.begin(), others.begin() + near / 2, others.begin() + near, by_residual);
  return others[static_cast<std::size_t>(near / 2)].second;
}

}  // namespace sheen::fitting::sparse
