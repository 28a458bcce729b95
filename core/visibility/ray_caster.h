// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>

namespace sheen::core {

/// Where a ray meets the mesh first.
struct RayHit {
  float distance = 0;  ///< along the direction, in units of its length
  std::uint32_t triangle_idx = 0;
  Eigen::Vector3f barycentric;  ///< weights of the triangle's three corners, sum 1
  bool front_face = true;       ///< met from the side the counter-clockwise winding faces
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

  /// Whether the mesh hides one of its vertices from `eye` (object frame, metres): a triangle whose
  /// front is turned towards the eye crosses the line between them. Triangles seen from behind do
  /// not hide, as in a depth pass with back-face culling. The triangles that have a corner at the
  /// vertex's position do not count, nor does anything nearer to the vertex than 1e-4 of the mesh's
  /// bounding diagonal.
  [[nodiscard]] bool vertex_hidden(std::uint32_t vertex_idx, const Eigen::Vector3f& eye) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::core
