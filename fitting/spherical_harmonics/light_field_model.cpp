// SPDX-License-Identifier: MIT
#include "fitting/spherical_harmonics/light_field_model.h"

#include "core/geometry/disc_map.h"
#include "fitting/half.h"

#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace sheen::fitting::spherical_harmonics {
namespace {

template <std::size_t kTerms>
Eigen::Vector3f sum_of_terms(const Eigen::half* coefficients, const Eigen::Vector3f& direction) {
  const auto Y = basis<kTerms>(direction.x(), direction.y(), direction.z());
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
  for (std::size_t term = 0; term < kTerms; ++term) {
    colour += Y[term] * colour_at(coefficients + 3 * term);
  }
  return colour;
}

}  // namespace

LightFieldModel::LightFieldModel(int degree, std::size_t patch_count)
    : degree_(degree),
      per_patch_(3 * term_count(degree)),
      coefficients_(patch_count * per_patch_, Eigen::half(0.0f)),
      observed_(patch_count, 0) {
  assert(degree >= 1 && degree <= kMaxDegree);
  for (std::size_t patch = 0; patch < patch_count; ++patch) {
    store_constant(patch, Eigen::Vector3f::Constant(0.5f));
  }
}

LightFieldModel::LightFieldModel(int degree, std::vector<Eigen::half> coefficients,
                                 std::vector<std::uint8_t> observed)
    : degree_(degree),
      per_patch_(3 * term_count(degree)),
      coefficients_(std::move(coefficients)),
      observed_(std::move(observed)) {
  assert(degree >= 1 && degree <= kMaxDegree);
  assert(coefficients_.size() == observed_.size() * per_patch_);
}

WeightedColour LightFieldModel::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  const Eigen::Vector3f direction = core::hemisphere_from_disc(uv);
  const Eigen::half* c = coefficients_.data() + patch_idx * per_patch_;
  const float weight = observed_[patch_idx] != 0 ? 1.0f : kUnseenWeight;
  switch (degree_) {
    case 1:
      return {weight * sum_of_terms<4>(c, direction), weight};
    case 2:
      return {weight * sum_of_terms<9>(c, direction), weight};
    default:
      return {weight * sum_of_terms<16>(c, direction), weight};
  }
}

Eigen::Vector3f LightFieldModel::mean_colour(std::size_t patch_idx) const {
  // Over the unit disc only m = 0 has a mean: z has 2/3, z^2 1/2 and z^3 2/5, so that Y_30 has
  // none.
  const Eigen::half* c = coefficients_.data() + patch_idx * per_patch_;
  Eigen::Vector3f mean = static_cast<float>(kY00) * colour_at(c);
  mean += basis<4>(0.0f, 0.0f, 2.0f / 3.0f)[2] * colour_at(c + 3 * 2);
  if (degree_ >= 2) {
    mean += basis<9>(0.0f, 0.0f, std::sqrt(0.5f))[6] * colour_at(c + 3 * 6);
  }
  return mean.cwiseMax(0.0f).cwiseMin(1.0f);
}

bool LightFieldModel::store(std::size_t patch_idx, std::span<const double> values) {
  assert(values.size() == per_patch_);
  Eigen::half* place = coefficients_.data() + patch_idx * per_patch_;
  bool changed = false;
  for (const double value : values) {
    assert(std::isfinite(value));
    changed |= replace(*place++, stored_half(value));
  }
  return changed;
}

bool LightFieldModel::store_constant(std::size_t patch_idx, const Eigen::Vector3f& colour) {
  std::array<double, 3 * term_count(kMaxDegree)> values{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    values[channel] = static_cast<double>(colour[static_cast<Eigen::Index>(channel)]) / kY00;
  }
  return store(patch_idx, std::span(values).first(per_patch_));
}

bool LightFieldModel::store_observed(std::size_t patch_idx, bool observed) {
  const std::uint8_t flag = observed ? 1 : 0;
  return std::exchange(observed_[patch_idx], flag) != flag;
}

}  // namespace sheen::fitting::spherical_harmonics
