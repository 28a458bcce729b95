// SPDX-License-Identifier: MIT
#include "evaluation/study/corruption.h"

#include "core/geometry/tangent_frame.h"

#include <algorithm>
#include <numbers>

namespace sheen::evaluation {

using Eigen::Vector3f;

Vector3f with_pose_error(const Vector3f& direction, const Corruption& corruption, Random& random) {
  const core::TangentFrame frame = core::tangent_frame(direction);
  const float scale = corruption.pose_error * std::numbers::pi_v<float> / 180.0f;
  const float x = scale * random.normal();
  const float y = scale * random.normal();
  Vector3f turned = direction + x * frame.tangent + y * frame.bitangent;
  turned.z() = std::max(turned.z(), 1e-3f);
  return turned.normalized();
}

Vector3f photographed(const Vector3f& radiance, const Corruption& corruption, Random& random) {
  // Draw everything always, so that one setting does not shift the stream of another.
  const bool is_outlier = random.uniform() < corruption.outliers;
  const Vector3f other(random.uniform(), random.uniform(), random.uniform());
  const Vector3f noise(random.normal(), random.normal(), random.normal());
  Vector3f colour = is_outlier ? other : Vector3f(corruption.exposure * radiance);
  // The sensor saturates, then the file rounds.
  colour += corruption.noise * noise;
  if (corruption.clamp) colour = colour.cwiseMax(0.0f).cwiseMin(1.0f);
  if (corruption.eight_bit) colour = (colour * 255.0f).array().round() / 255.0f;
  return colour;
}

}  // namespace sheen::evaluation
