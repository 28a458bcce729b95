// SPDX-License-Identifier: MIT
#pragma once

#include "capture/synthetic/lighting.h"
#include "core/mesh/mesh.h"
#include "core/visibility/ray_caster.h"

#include <Eigen/Core>

#include <vector>

namespace sheen::capture::synthetic {

/// Light that reaches a plane z = 0 under the object: a grid of irradiances around the origin,
/// unshadowed beyond it. Board frame.
class GroundLight {
 public:
  GroundLight(const Studio& studio, const core::RayCaster& object, float half_width_m, int threads);

  /// Irradiance at (x, y, 0), linear RGB, bilinear between the grid's points.
  [[nodiscard]] Eigen::Vector3f irradiance(float x, float y) const;

 private:
  static constexpr int kPoints = 129;
  float half_width_m_;
  Eigen::Vector3f unshadowed_;
  std::vector<Eigen::Vector3f> grid_;
};

/// Light at every vertex of `object` (board frame), shadowed by the object itself and brightened by
/// the board below, whose mean reflectance is `board_reflectance`. Baked, because the shadows do
/// not move with the eye, and smooth, because every vertex looks along the same directions.
std::vector<Incident> bake_incident(const Studio& studio, const core::Mesh& object,
                                    const core::RayCaster& caster, const GroundLight& ground,
                                    float board_reflectance, int threads);

}  // namespace sheen::capture::synthetic
