// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// A view and its part of a mixture.
struct ViewShare {
  std::uint32_t view_idx;
  float share;
};

/// Directions of views and the triangles between them: Delaunay's on the sphere but for one hole
/// where views are farthest. Directions on a circle, as of a turntable, are joined along it.
class ViewSphere {
 public:
  /// Unit vectors; of equal ones the first counts.
  explicit ViewSphere(std::vector<Eigen::Vector3d> directions);

  [[nodiscard]] const std::vector<Eigen::Vector3d>& directions() const { return directions_; }
  /// Views next to one, by rising angle: those that share an edge with it and have no other view in
  /// the circle over that edge, so across no hole.
  [[nodiscard]] const std::vector<std::uint32_t>& neighbours(std::size_t view_idx) const {
    return neighbours_[view_idx];
  }
  /// Views that share an edge with one: all with which it can be mixed.
  [[nodiscard]] const std::vector<std::uint32_t>& mixed_with(std::size_t view_idx) const {
    return mixed_with_[view_idx];
  }
  /// Linear between the corners of the triangle that holds the direction; outside all of them
  /// along the nearest edge. One to three shares with sum 1, none where there is no view.
  [[nodiscard]] std::vector<ViewShare> shares(const Eigen::Vector3d& direction) const;

 private:
  using Edge = std::array<std::uint32_t, 2>;
  struct Triangle {
    std::array<std::uint32_t, 3> corners;
    Eigen::Matrix3d shares_from_direction;
  };

  void triangulate();
  [[nodiscard]] bool has_view_between(const Edge& edge) const;
  void add_triangle(const std::array<std::uint32_t, 3>& corners);

  std::vector<Eigen::Vector3d> directions_;
  std::vector<Edge> edges_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> neighbours_, mixed_with_;
};

}  // namespace sheen::fitting::multi_eigenspace
