// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::heights {

/// One height per distinct position of a mesh, along the mean of the normals there.
class HeightField {
 public:
  /// All heights 0. `mesh` outlives it.
  explicit HeightField(const core::Mesh& mesh);

  [[nodiscard]] std::size_t size() const { return direction_.size(); }
  /// The one that moves a vertex.
  [[nodiscard]] std::uint32_t of_vertex(std::size_t vertex_idx) const { return index_[vertex_idx]; }
  /// Unit vectors; zero where the normals cancel, which stay where they are.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& directions() const { return direction_; }
  /// Metres.
  [[nodiscard]] Eigen::VectorXd& heights() { return height_; }
  [[nodiscard]] const Eigen::VectorXd& heights() const { return height_; }

  struct Edge {
    std::uint32_t first, second;  ///< heights
    float length_m;               ///< > 0
  };
  /// Of the mesh, each once, sorted.
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }

  /// The mesh with its positions moved, and its normals turned as the surface around them turns.
  [[nodiscard]] core::Mesh raised() const;

 private:
  const core::Mesh& mesh_;
  std::vector<std::uint32_t> index_;
  std::vector<Eigen::Vector3f> direction_;
  std::vector<Edge> edges_;
  Eigen::VectorXd height_;
};

}  // namespace sheen::fitting::heights
