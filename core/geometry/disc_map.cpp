// SPDX-License-Identifier: MIT
#include "core/geometry/disc_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::core {
namespace {
constexpr float kQuarterPi = std::numbers::pi_v<float> / 4.0f;
}

Eigen::Vector2f disc_from_hemisphere(const Eigen::Vector3f& direction) {
  return direction.head<2>();
}

Eigen::Vector3f hemisphere_from_disc(const Eigen::Vector2f& uv) {
  const float r2 = uv.squaredNorm();
  if (r2 >= 1.0f) {
    const Eigen::Vector2f rim = uv / std::sqrt(r2);
    return {rim.x(), rim.y(), 0.0f};
  }
  return {uv.x(), uv.y(), std::sqrt(1.0f - r2)};
}

Eigen::Vector2f disc_from_square(const Eigen::Vector2f& ab) {
  const float a = ab.x();
  const float b = ab.y();
  if (a == 0.0f && b == 0.0f) return {0.0f, 0.0f};
  // A negative radius turns the angle by half a circle, so two branches serve all four wedges.
  const bool horizontal = std::abs(a) > std::abs(b);
  const float r = horizontal ? a : b;
  const float phi = horizontal ? kQuarterPi * (b / a) : 2.0f * kQuarterPi - kQuarterPi * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

Eigen::Vector2f square_from_disc(const Eigen::Vector2f& uv) {
  const float r = uv.norm();
  if (r == 0.0f) return {0.0f, 0.0f};
  float phi = std::atan2(uv.y(), uv.x());
  if (phi < -kQuarterPi) phi += 8.0f * kQuarterPi;
  if (phi < kQuarterPi) return {r, r * phi / kQuarterPi};
  if (phi < 3.0f * kQuarterPi) return {r * (2.0f * kQuarterPi - phi) / kQuarterPi, r};
  if (phi < 5.0f * kQuarterPi) return {-r, r * (4.0f * kQuarterPi - phi) / kQuarterPi};
  return {r * (phi - 6.0f * kQuarterPi) / kQuarterPi, -r};
}

}  // namespace sheen::core
