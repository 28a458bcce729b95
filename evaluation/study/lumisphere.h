// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/study/environment.h"
#include "evaluation/study/material.h"

#include <Eigen/Core>

#include <vector>

namespace sheen::evaluation {

/// Radiance that a point of a surface sends into every direction of its hemisphere: material x
/// environment, unoccluded, no interreflection. Exact and deterministic.
class Lumisphere {
 public:
  /// Columns of `world_from_patch` are tangent, bitangent, normal.
  Lumisphere(const Material& material, const Eigen::Matrix3f& world_from_patch,
             const Environment& environment);

  /// Radiance on the scale of display values (the environments are lit so that a few percent of
  /// the samples of glossy points clamp), not clamped, towards `view` (unit, patch frame, z > 0).
  [[nodiscard]] Eigen::Vector3f radiance(const Eigen::Vector3f& view) const;

 private:
  Material material_;
  Eigen::Vector3f diffuse_{0, 0, 0};
  // Lights above the horizon: direction in the patch frame, Smith's Lambda, power / 4.
  std::vector<Eigen::Vector3f> direction_;
  std::vector<float> lambda_;
  std::vector<Eigen::Vector3f> power_;
};

}  // namespace sheen::evaluation
