// SPDX-License-Identifier: MIT
#include "fitting/iwls/light_field_model.h"

#include "fitting/half.h"
#include "fitting/iwls/wendland.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace sheen::fitting::iwls {
namespace {

// The polynomial of one centre at d, eq. 6.
Eigen::Vector3f polynomial_at(const Eigen::half* c, int terms, const Eigen::Vector2f& d) {
  Eigen::Vector3f value = colour_at(c);
  if (terms >= 3) value += d.x() * colour_at(c + 3) + d.y() * colour_at(c + 6);
  if (terms >= 6) {
    value += d.x() * d.x() * colour_at(c + 9) + d.x() * d.y() * colour_at(c + 12) +
             d.y() * d.y() * colour_at(c + 15);
  }
  return value;
}

}  // namespace

LightFieldModel::LightFieldModel(ModelShape shape, std::size_t patch_count)
    : shape_(std::move(shape)),
      per_patch_(shape_.centers.size() * static_cast<std::size_t>(3 * shape_.terms)),
      coefficients_(patch_count * per_patch_, Eigen::half(0.0f)),
      observed_(patch_count, 0) {
  for (std::size_t patch = 0; patch < patch_count; ++patch) {
    store_constant(patch, Eigen::Vector3f::Constant(0.5f));
  }
}

LightFieldModel::LightFieldModel(ModelShape shape, std::vector<Eigen::half> coefficients,
                                 std::vector<std::uint8_t> observed)
    : shape_(std::move(shape)),
      per_patch_(shape_.centers.size() * static_cast<std::size_t>(3 * shape_.terms)),
      coefficients_(std::move(coefficients)),
      observed_(std::move(observed)) {
  assert(coefficients_.size() == observed_.size() * per_patch_);
}

WeightedColour LightFieldModel::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  // Rounding may push a grazing direction over the rim: put it back, where supports still cover.
  const float radius = uv.norm();
  const Eigen::Vector2f x = radius > 1.0f ? Eigen::Vector2f(uv / radius) : uv;
  // Sum the centres whose support covers the direction.
  const float inverse_h = 1.0f / shape_.support_radius;
  const auto stride = static_cast<std::size_t>(3 * shape_.terms);
  const Eigen::half* c = coefficients_.data() + patch_idx * per_patch_;
  WeightedColour sum{Eigen::Vector3f::Zero(), 0.0f};
  for (const Eigen::Vector2f& center : shape_.centers) {
    const Eigen::Vector2f d = (x - center) * inverse_h;
    const float distance2 = d.squaredNorm();
    if (distance2 < 1.0f) {
      const float theta = wendland(std::sqrt(distance2));
      sum.colour_sum += theta * polynomial_at(c, shape_.terms, d);
      sum.weight_sum += theta;
    }
    c += stride;
  }
  // A patch nobody saw leaves the decision to its neighbours.
  if (observed_[patch_idx] == 0) {
    sum.colour_sum *= kUnseenWeight;
    sum.weight_sum *= kUnseenWeight;
  }
  return sum;
}

Eigen::Vector3f LightFieldModel::mean_colour(std::size_t patch_idx) const {
  const auto stride = static_cast<std::size_t>(3 * shape_.terms);
  const Eigen::half* c = coefficients_.data() + patch_idx * per_patch_;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0.0f;
  for (const Eigen::Vector2f& center : shape_.centers) {
    if (center.squaredNorm() <= 1.0f) {
      sum += colour_at(c);
      count += 1.0f;
    }
    c += stride;
  }
  return (sum / std::max(count, 1.0f)).cwiseMax(0.0f).cwiseMin(1.0f);
}

bool LightFieldModel::store(std::size_t patch_idx, std::size_t center_idx,
                            std::span<const double> values) {
  const auto stride = static_cast<std::size_t>(3 * shape_.terms);
  assert(values.size() == stride);
  Eigen::half* place = coefficients_.data() + patch_idx * per_patch_ + center_idx * stride;
  bool changed = false;
  for (const double value : values) changed |= replace(*place++, stored_half(value));
  return changed;
}

bool LightFieldModel::store_constant(std::size_t patch_idx, const Eigen::Vector3f& colour) {
  Eigen::half* place = coefficients_.data() + patch_idx * per_patch_;
  bool changed = false;
  for (std::size_t center = 0; center < shape_.centers.size(); ++center) {
    for (int term = 0; term < shape_.terms; ++term) {
      for (int channel = 0; channel < 3; ++channel) {
        const float value = term == 0 ? colour[channel] : 0.0f;
        changed |= replace(*place++, stored_half(static_cast<double>(value)));
      }
    }
  }
  return changed;
}

bool LightFieldModel::store_observed(std::size_t patch_idx, bool observed) {
  const std::uint8_t flag = observed ? 1 : 0;
  return std::exchange(observed_[patch_idx], flag) != flag;
}

}  // namespace sheen::fitting::iwls
