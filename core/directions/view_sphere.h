// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// Up to three directions of a sphere that stand for another one. Weights are >= 0 and add up to 1.
struct SphereBlend {
  std::array<std::uint32_t, 3> index{};
  std::array<float, 3> weight{1.0f, 0.0f, 0.0f};
};

/// Interpolates between directions: spherical Delaunay triangles, which are the faces of the convex
/// hull of the unit directions (Qhull). Triangles whose circle is wider than 60 degrees around its
/// centre span no neighbours and are left out; a direction in none is moved to the nearest place on
/// an edge, so nothing is extrapolated.
class ViewSphere {
 public:
  /// Unit vectors; repeated ones and any number of them are fine.
  explicit ViewSphere(std::vector<Eigen::Vector3d> directions);

  [[nodiscard]] std::size_t size() const { return directions_.size(); }
  /// Barycentric in the triangle that holds `direction` (unit vector), or between the ends of the
  /// nearest edge; continuous inside the triangles and across their borders. size() > 0.
  [[nodiscard]] SphereBlend blend(const Eigen::Vector3d& direction) const;

  using Triangle = std::array<std::uint32_t, 3>;
  using Edge = std::array<std::uint32_t, 2>;
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Those that have no triangle on at least one side.
  [[nodiscard]] const std::vector<Edge>& borders() const { return borders_; }

 private:
  void keep_faces(const std::vector<Triangle>& faces);
  void join_in_a_ring();

  std::vector<Eigen::Vector3d> directions_;
  std::vector<Triangle> triangles_;
  std::vector<Eigen::Matrix3d> barycentric_;  ///< of every triangle: direction to weights
  std::vector<Edge> borders_;
};

}  // namespace sheen::core
