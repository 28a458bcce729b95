// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// Which views lie next to which, by the edges of their triangles (core::ViewSphere).
class ViewGraph {
 public:
  /// Unit vectors.
  explicit ViewGraph(std::span<const Eigen::Vector3d> directions);

  /// Views next to one, by rising angle: those that share an edge with it and have no other view in
  /// the circle over that edge, so across no hole.
  [[nodiscard]] const std::vector<std::uint32_t>& neighbours(std::size_t view_idx) const {
    return neighbours_[view_idx];
  }
  /// Views that share an edge with one: all with which it can be mixed.
  [[nodiscard]] const std::vector<std::uint32_t>& mixed_with(std::size_t view_idx) const {
    return mixed_with_[view_idx];
  }

 private:
  void join(std::uint32_t a, std::uint32_t b);
  [[nodiscard]] bool has_view_between(std::uint32_t a, std::uint32_t b) const;

  std::span<const Eigen::Vector3d> directions_;
  std::vector<std::vector<std::uint32_t>> neighbours_, mixed_with_;
};

}  // namespace sheen::fitting::multi_eigenspace
