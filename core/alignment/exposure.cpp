// SPDX-License-Identifier: MIT
#include "core/alignment/exposure.h"

#include "core/numerics/median.h"

#include <cassert>

namespace sheen::core {

std::optional<double> estimate_gain(const std::vector<float>& measured,
                                    const std::vector<float>& predicted,
                                    const ExposureLimits& limits, std::vector<double>& ratios) {
  assert(measured.size() == predicted.size());
  // Written so that values that are not numbers fall out.
  const auto well_exposed = [&](float value) {
    return value >= limits.darkest && value <= limits.brightest;
  };
  ratios.clear();
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!well_exposed(measured[i]) || !well_exposed(predicted[i])) continue;
    ratios.push_back(static_cast<double>(measured[i]) / static_cast<double>(predicted[i]));
  }
  if (ratios.empty() || ratios.size() < limits.min_pairs) return std::nullopt;
  const double gain = upper_median(ratios);
  if (gain > limits.largest_change || gain < 1 / limits.largest_change) return std::nullopt;
  return gain;
}

}  // namespace sheen::core
