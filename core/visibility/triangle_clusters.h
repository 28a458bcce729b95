// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// A mesh's triangles in groups that lie together and face one way, so that most of those turned
/// away from an eye are refused a group at a time and the rest are drawn where the cache is warm.
class TriangleClusters {
 public:
  static constexpr std::size_t kTriangles = 64;  ///< of every cluster, padding included

  explicit TriangleClusters(const Mesh& mesh);

  [[nodiscard]] std::size_t size() const { return bounds_.size(); }

  /// Whether no triangle of the cluster turns its front to `eye` (object frame, metres). May say
  /// no where yes is true.
  [[nodiscard]] bool faces_away(std::size_t cluster_idx, const Eigen::Vector3f& eye) const;

  /// kTriangles vertex indices each, one array per corner, counter-clockwise seen from outside;
  /// padded with triangles of one point.
  [[nodiscard]] const std::uint32_t* corners(std::size_t cluster_idx, int corner) const {
    return corners_[corner].data() + cluster_idx * kTriangles;
  }

 private:
  /// A ball that holds the triangles and a cone that holds their normals.
  struct Bounds {
    Eigen::Vector3f centre;
    float radius_m;
    Eigen::Vector3f axis;
    float sine;  ///< of the cone's half opening; above 1 where half a sphere does not hold it
  };

  static Bounds bounds_of(const Mesh& mesh, const std::uint32_t* triangles, std::size_t count);

  std::vector<Bounds> bounds_;
  std::vector<std::uint32_t> corners_[3];
};

}  // namespace sheen::core
