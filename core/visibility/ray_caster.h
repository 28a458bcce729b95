// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>

#include "core/mesh/mesh.h"

namespace sheen::core {

/// Where a ray meets the mesh first.
struct RayHit {
  float distance = 0;             ///< along the direction, in units of its length
  std::uint32_t triangle_idx = 0;
  Eigen::Vector3f barycentric;    ///< weights of the triangle's three corners, sum 1
  bool front_face = true;         ///< met from the side the counter-clockwise winding faces
};

/// Embree's hierarchy over one mesh. All members may be called from several threads at once.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// First hit with distance in (near, far).
  [[nodiscard]] std::optional<RayHit> first_hit(const Eigen::Vector3f& origin,
                                                const Eigen::Vector3f& direction, float near,
                                                float far) const;

  /// Whether anything lies between near and far.
  [[nodiscard]] bool occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                              float near, float far) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::core
