// SPDX-License-Identifier: MIT
#include "fitting/iwls/light_field_model.h"

#include "fitting/half.h"
#include "fitting/iwls/slots.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace sheen::fitting::iwls {
namespace {

// Slots without a centre stand where no support reaches: the model file limits its radius.
constexpr float kUnusedCenter = 1e6f;

}  // namespace

LightFieldModel::LightFieldModel(ModelShape shape, std::size_t patch_count)
    : shape_(std::move(shape)),
      slots_(slots_of_centers(shape_.centers.size())),
      u_(slot_count(slots_.size()), kUnusedCenter),
      v_(u_),
      evaluate_(evaluate_kernels().of_terms(shape_.terms)),
      per_patch_(u_.size() * static_cast<std::size_t>(3 * shape_.terms)),
      coefficients_(patch_count * per_patch_, Eigen::half(0.0f)),
      observed_(patch_count, 0) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    u_[slots_[i]] = shape_.centers[i].x();
    v_[slots_[i]] = shape_.centers[i].y();
  }
  for (std::size_t patch = 0; patch < patch_count; ++patch) {
    store_constant(patch, Eigen::Vector3f::Constant(0.5f));
  }
}

LightFieldModel::LightFieldModel(ModelShape shape, const std::vector<Eigen::half>& coefficients,
                                 std::vector<std::uint8_t> observed)
    : LightFieldModel(std::move(shape), observed.size()) {
  assert(coefficients.size() == coefficient_count());
  auto value = coefficients.begin();
  for (std::size_t patch = 0; patch < observed.size(); ++patch) {
    for (std::size_t center = 0; center < slots_.size(); ++center) {
      for (std::size_t i = 0; i < values_per_center(); ++i) {
        coefficients_[place(patch, center, i)] = *value++;
      }
    }
  }
  observed_ = std::move(observed);
}

std::vector<Eigen::half> LightFieldModel::coefficients_by_center() const {
  std::vector<Eigen::half> coefficients;
  coefficients.reserve(coefficient_count());
  for (std::size_t patch = 0; patch < observed_.size(); ++patch) {
    for (std::size_t center = 0; center < slots_.size(); ++center) {
      for (std::size_t i = 0; i < values_per_center(); ++i) {
        coefficients.push_back(coefficients_[place(patch, center, i)]);
      }
    }
  }
  return coefficients;
}

std::size_t LightFieldModel::place(std::size_t patch_idx, std::size_t center_idx,
                                   std::size_t value) const {
  const std::size_t slot = slots_[center_idx];
  return patch_idx * per_patch_ + slot / kLanes * kLanes * values_per_center() + kLanes * value +
         slot % kLanes;
}

WeightedColour LightFieldModel::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  // Rounding may push a grazing direction over the rim: put it back, where supports still cover.
  const float radius = uv.norm();
  const Eigen::Vector2f x = radius > 1.0f ? Eigen::Vector2f(uv / radius) : uv;
  Eigen::Vector4f sums;
  evaluate_({u_.data(), v_.data(), u_.size() / kLanes, 1.0f / shape_.support_radius},
            &coefficients_.data()[patch_idx * per_patch_].x, x.x(), x.y(), sums.data());
  // A patch nobody saw leaves the decision to its neighbours.
  if (observed_[patch_idx] == 0) sums *= kUnseenWeight;
  return {sums.head<3>(), sums[3]};
}

Eigen::Vector3f LightFieldModel::mean_colour(std::size_t patch_idx) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0.0f;
  for (std::size_t center = 0; center < slots_.size(); ++center) {
    if (shape_.centers[center].squaredNorm() > 1.0f) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      sum[static_cast<Eigen::Index>(i)] +=
          static_cast<float>(coefficients_[place(patch_idx, center, i)]);
    }
    count += 1.0f;
  }
  return (sum / std::max(count, 1.0f)).cwiseMax(0.0f).cwiseMin(1.0f);
}

bool LightFieldModel::store(std::size_t patch_idx, std::size_t center_idx,
                            std::span<const double> values) {
  assert(values.size() == values_per_center());
  bool changed = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    changed |= replace(coefficients_[place(patch_idx, center_idx, i)], stored_half(values[i]));
  }
  return changed;
}

bool LightFieldModel::store_constant(std::size_t patch_idx, const Eigen::Vector3f& colour) {
  bool changed = false;
  for (std::size_t center = 0; center < slots_.size(); ++center) {
    for (std::size_t i = 0; i < values_per_center(); ++i) {
      const float value = i < 3 ? colour[static_cast<Eigen::Index>(i)] : 0.0f;
      changed |= replace(coefficients_[place(patch_idx, center, i)],
                         stored_half(static_cast<double>(value)));
    }
  }
  return changed;
}

bool LightFieldModel::store_observed(std::size_t patch_idx, bool observed) {
  const std::uint8_t flag = observed ? 1 : 0;
  return std::exchange(observed_[patch_idx], flag) != flag;
}

}  // namespace sheen::fitting::iwls
