// SPDX-License-Identifier: MIT
#include "fitting/mean/mean_light_field.h"

#include "fitting/half.h"

#include <cassert>
#include <utility>

namespace sheen::fitting::mean {

MeanLightField::MeanLightField(std::size_t patch_count)
    : coefficients_(3 * patch_count, Eigen::half(0.5f)), observed_(patch_count, 0) {}

MeanLightField::MeanLightField(std::vector<Eigen::half> coefficients,
                               std::vector<std::uint8_t> observed)
    : coefficients_(std::move(coefficients)), observed_(std::move(observed)) {
  assert(coefficients_.size() == 3 * observed_.size());
}

WeightedColour MeanLightField::evaluate(std::size_t patch_idx, const Eigen::Vector2f&) const {
  const float weight = observed_[patch_idx] != 0 ? 1.0f : kUnseenWeight;
  return {weight * mean_colour(patch_idx), weight};
}

Eigen::Vector3f MeanLightField::mean_colour(std::size_t patch_idx) const {
  return colour_at(coefficients_.data() + 3 * patch_idx);
}

bool MeanLightField::store(std::size_t patch_idx, const Eigen::Vector3f& colour, bool observed) {
  const std::uint8_t flag = observed ? 1 : 0;
  bool changed = std::exchange(observed_[patch_idx], flag) != flag;
  for (int channel = 0; channel < 3; ++channel) {
    Eigen::half& place = coefficients_[3 * patch_idx + static_cast<std::size_t>(channel)];
    changed |= replace(place, stored_half(static_cast<double>(colour[channel])));
  }
  return changed;
}

}  // namespace sheen::fitting::mean
