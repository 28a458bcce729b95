// SPDX-License-Identifier: MIT
#include "core/mesh/refine_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace sheen::core {
namespace {

using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;

/// An undirected edge as one sortable number.
std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

/// The edges that are too long, sorted, each once. An edge's place in the list tells its midpoint.
std::vector<std::uint64_t> long_edges(const Mesh& mesh, float max_edge_m) {
  std::vector<std::uint64_t> edges;
  for (const Triangle& triangle : mesh.triangles) {
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t a = triangle[side];
      const std::uint32_t b = triangle[(side + 1) % 3];
      const float length_m = (mesh.positions[a] - mesh.positions[b]).norm();
      if (length_m > max_edge_m) edges.push_back(edge_key(a, b));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

void add_midpoints(const std::vector<std::uint64_t>& edges, Mesh& mesh) {
  for (const std::uint64_t edge : edges) {
    const auto a = static_cast<std::size_t>(edge >> 32U);
    const auto b = static_cast<std::size_t>(edge & 0xffffffffU);
    mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
    const Eigen::Vector3f normal = mesh.normals[a] + mesh.normals[b];
    const float length = normal.norm();
    mesh.normals.push_back(length > 1e-6f ? Eigen::Vector3f(normal / length) : mesh.normals[a]);
  }
}

/// Midpoint of every side of a triangle, where it has one.
class Midpoints {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  Midpoints(const std::vector<std::uint64_t>& edges, std::size_t first_vertex)
      : edges_(edges), first_vertex_(first_vertex) {}

  [[nodiscard]] std::uint32_t of(std::uint32_t a, std::uint32_t b) const {
    const std::uint64_t key = edge_key(a, b);
    const auto place = std::lower_bound(edges_.begin(), edges_.end(), key);
    if (place == edges_.end() || *place != key) return kNone;
    return static_cast<std::uint32_t>(first_vertex_ +
                                      static_cast<std::size_t>(place - edges_.begin()));
  }

 private:
  const std::vector<std::uint64_t>& edges_;
  std::size_t first_vertex_;
};

/// Replaces a triangle by the pieces its split sides make: 1, 2, 3 or 4.
void split(const Triangle& triangle, const Midpoints& midpoints, std::vector<Triangle>& pieces) {
  std::array<std::uint32_t, 3> corner{triangle[0], triangle[1], triangle[2]};
  std::array<std::uint32_t, 3> middle{};  // middle[i] lies between corner i and i + 1
  int split_sides = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = midpoints.of(corner[i], corner[(i + 1) % 3]);
    split_sides += middle[i] != Midpoints::kNone ? 1 : 0;
  }
  if (split_sides == 0) {
    pieces.push_back(triangle);
    return;
  }
  if (split_sides == 3) {
    pieces.emplace_back(middle[0], middle[1], middle[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      pieces.emplace_back(corner[i], middle[i], middle[(i + 2) % 3]);
    }
    return;
  }
  // Turn the triangle until side 0 is split and side 2 is not.
  while (middle[0] == Midpoints::kNone || middle[2] != Midpoints::kNone) {
    std::rotate(corner.begin(), corner.begin() + 1, corner.end());
    std::rotate(middle.begin(), middle.begin() + 1, middle.end());
  }
  if (split_sides == 1) {
    pieces.emplace_back(corner[0], middle[0], corner[2]);
    pieces.emplace_back(middle[0], corner[1], corner[2]);
    return;
  }
  pieces.emplace_back(middle[0], corner[1], middle[1]);
  pieces.emplace_back(corner[0], middle[0], middle[1]);
  pieces.emplace_back(corner[0], middle[1], corner[2]);
}

}  // namespace

Mesh refine_mesh(const Mesh& mesh, float max_edge_m, std::size_t max_vertices) {
  assert(max_edge_m > 0);
  Mesh refined = mesh;
  while (true) {
    const std::vector<std::uint64_t> edges = long_edges(refined, max_edge_m);
    const std::size_t first_new = refined.positions.size();
    if (edges.empty() || first_new + edges.size() > max_vertices) return refined;
    add_midpoints(edges, refined);
    const Midpoints midpoints(edges, first_new);
    std::vector<Triangle> pieces;
    pieces.reserve(refined.triangles.size() + 2 * edges.size());
    for (const Triangle& triangle : refined.triangles) split(triangle, midpoints, pieces);
    refined.triangles = std::move(pieces);
  }
}

}  // namespace sheen::core
