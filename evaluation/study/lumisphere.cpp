// SPDX-License-Identifier: MIT
#include "evaluation/study/lumisphere.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace sheen::evaluation {

using Eigen::Vector3f;

Lumisphere::Lumisphere(const Material& material, const Eigen::Matrix3f& world_from_patch,
                       const Environment& environment)
    : material_(material) {
  constexpr float lowest = 1e-3f;  // below, light at the horizon adds nothing but rounding errors
  for (std::size_t i = 0; i < environment.direction.size(); ++i) {
    const Vector3f local = world_from_patch.transpose() * environment.direction[i];
    if (local.z() < lowest) continue;
    const Vector3f& power = environment.power[i];
    diffuse_ += material.albedo.cwiseProduct(power) * (local.z() / std::numbers::pi_v<float>);
    if (!material.is_glossy()) continue;
    direction_.push_back(local);
    lambda_.push_back(smith_lambda(material, local));
    // The cosine of the light cancels against the one in the microfacet model's denominator.
    power_.push_back(power * 0.25f);
  }
}

// The same sum as over `reflectance` (tests/bench), with what does not depend on the light and what
// does not depend on the view taken out of the loop.
Vector3f Lumisphere::radiance(const Vector3f& view) const {
  const float inverse_x = 1.0f / material_.alpha_x;
  const float inverse_y = 1.0f / material_.alpha_y;
  const float view_lambda = 1.0f + smith_lambda(material_, view);
  Vector3f at_normal = Vector3f::Zero();
  Vector3f at_grazing = Vector3f::Zero();
  for (std::size_t i = 0; i < direction_.size(); ++i) {
    const Vector3f half = (direction_[i] + view).normalized();
    const float x = half.x() * inverse_x;
    const float y = half.y() * inverse_y;
    const float stretched = x * x + y * y + half.z() * half.z();
    const Vector3f part = power_[i] / (stretched * stretched * (view_lambda + lambda_[i]));
    const float m = 1.0f - half.dot(view);
    at_normal += part;
    at_grazing += part * (m * m * m * m * m);
  }
  const float scale = inverse_x * inverse_y / (std::numbers::pi_v<float> * view.z());
  const Vector3f tint = Vector3f::Ones() - material_.f0;
  return diffuse_ + scale * (material_.f0.cwiseProduct(at_normal) + tint.cwiseProduct(at_grazing));
}

}  // namespace sheen::evaluation
