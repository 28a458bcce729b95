// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace sheen::reconstruction {

/// A place on a mesh.
struct SurfacePlace {
  Eigen::Vector3f point;  ///< on the triangle
  std::uint32_t triangle_idx = 0;
  Eigen::Vector3f barycentric;  ///< weights of the triangle's three corners, sum 1
  float distance = 0;           ///< from the point that was asked about
};

/// The point of a triangle nearest to `p`, by the regions of its plane (Ericson 2005, 5.1.5).
SurfacePlace closest_on_triangle(const Eigen::Vector3f& p, const Eigen::Vector3f& a,
                                 const Eigen::Vector3f& b, const Eigen::Vector3f& c);

/// Boxes round boxes round the triangles of a mesh, for questions of nearness. Points to the mesh,
/// which must outlive it and stay as it is. Members may be called from several threads at once.
class TriangleTree {
 public:
  explicit TriangleTree(const core::Mesh& mesh);

  /// The nearest place on the mesh; distance infinite for a mesh without triangles, or when none is
  /// nearer than `within`.
  [[nodiscard]] SurfacePlace closest(const Eigen::Vector3f& point,
                                     float within = std::numeric_limits<float>::infinity()) const;

  /// Calls `visit` with every triangle whose box meets `box`, in no particular but always the same
  /// order.
  void for_each_in(const Eigen::AlignedBox3f& box,
                   const std::function<void(std::uint32_t triangle_idx)>& visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3f box;
    std::uint32_t begin = 0;  ///< of its triangles in order_
    std::uint32_t end = 0;
    std::uint32_t right = 0;  ///< second child; the first one follows its parent; 0: a leaf
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end,
                      const std::vector<Eigen::AlignedBox3f>& boxes);

  const core::Mesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace sheen::reconstruction
