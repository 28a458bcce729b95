// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace sheen::reconstruction {

/// A closed, manifold triangle mesh that can be changed edge by edge. Half-edge h lies in triangle
/// h / 3 and runs from its own vertex to that of its successor; every half-edge has a twin.
class EdgeMesh {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = ~Index{0};

  /// Throws std::invalid_argument when some edge has not exactly two triangles, one in either
  /// direction, or a vertex has more than one fan of triangles.
  explicit EdgeMesh(const core::Mesh& mesh);

  /// Without what was removed, vertices in order; normals complete.
  [[nodiscard]] core::Mesh mesh() const;

  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  [[nodiscard]] Index twin(Index h) const { return twins_[h]; }
  [[nodiscard]] Index from(Index h) const { return vertices_[h]; }
  [[nodiscard]] Index to(Index h) const { return vertices_[next(h)]; }
  /// The vertex of the half-edge's triangle that is not on it.
  [[nodiscard]] Index across(Index h) const { return vertices_[previous(h)]; }

  [[nodiscard]] Index half_edges() const { return static_cast<Index>(vertices_.size()); }
  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(positions_.size()); }
  [[nodiscard]] bool is_alive(Index h) const { return vertices_[h] != kNone; }
  [[nodiscard]] bool has_vertex(Index v) const { return outgoing_[v] != kNone; }
  [[nodiscard]] const Eigen::Vector3f& position(Index v) const { return positions_[v]; }
  void move(Index v, const Eigen::Vector3f& to) { positions_[v] = to; }
  [[nodiscard]] float length(Index h) const {
    return (positions_[to(h)] - positions_[from(h)]).norm();
  }
  /// Twice the area times the unit normal of a triangle.
  [[nodiscard]] Eigen::Vector3f area_normal(Index triangle) const;
  /// Sum of the area normals round a vertex.
  [[nodiscard]] Eigen::Vector3f vertex_normal(Index v) const;

  /// Calls visit(h) with every half-edge that leaves the vertex, round it.
  template <typename Visit>
  void for_each_outgoing(Index v, const Visit& visit) const {
    const Index first = outgoing_[v];
    Index h = first;
    do {
      visit(h);
      h = twins_[previous(h)];
    } while (h != first);
  }
  [[nodiscard]] int valence(Index v) const;

  /// Puts a vertex at the middle of an edge; returns it.
  Index split(Index h);

  /// Whether an edge may be collapsed without changing the topology, and no triangle's normal turns
  /// by more than about 60 degrees when its end `from(h)` goes and `to(h)` moves to `place`.
  [[nodiscard]] bool may_collapse(Index h, const Eigen::Vector3f& place) const;
  /// Removes vertex from(h), two triangles and moves to(h) to `place`.
  void collapse(Index h, const Eigen::Vector3f& place);

  /// Whether the other diagonal of the edge's two triangles is free, and both new triangles face as
  /// the old ones do.
  [[nodiscard]] bool may_flip(Index h) const;
  void flip(Index h);

 private:
  void join(Index a, Index b) {
    twins_[a] = b;
    twins_[b] = a;
  }
  [[nodiscard]] bool keeps_facing(Index h, Index moved, Index gone,
                                  const Eigen::Vector3f& place) const;

  std::vector<Eigen::Vector3f> positions_;
  std::vector<Index> vertices_;  ///< per half-edge, where it begins; kNone: removed
  std::vector<Index> twins_;
  std::vector<Index> outgoing_;  ///< per vertex, one of its half-edges; kNone: removed
};

}  // namespace sheen::reconstruction
