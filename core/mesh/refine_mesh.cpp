// SPDX-License-Identifier: MIT
#include "core/mesh/refine_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <utility>

namespace sheen::core {
namespace {

using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;

/// An undirected edge as one sortable number.
std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

/// Equal for both sides of a hard edge: a - b and b - a differ in their signs only.
float length_of(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  return (mesh.positions[a] - mesh.positions[b]).norm();
}

float length_of(const Mesh& mesh, std::uint64_t edge) {
  return length_of(mesh, static_cast<std::uint32_t>(edge >> 32U),
                   static_cast<std::uint32_t>(edge & 0xffffffffU));
}

/// The edges that are too long, sorted, each once. An edge's place in the list tells its midpoint.
std::vector<std::uint64_t> long_edges(const Mesh& mesh, float max_edge_m) {
  std::vector<std::uint64_t> edges;
  for (const Triangle& triangle : mesh.triangles) {
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t a = triangle[side];
      const std::uint32_t b = triangle[(side + 1) % 3];
      if (length_of(mesh, a, b) > max_edge_m) edges.push_back(edge_key(a, b));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Leaves the `most` longest edges or fewer: of equal ones all or none, lest one side of a hard
/// edge be split and the other not.
void keep_longest(const Mesh& mesh, std::size_t most, std::vector<std::uint64_t>& edges) {
  std::vector<float> lengths_m(edges.size());
  std::transform(edges.begin(), edges.end(), lengths_m.begin(),
                 [&](std::uint64_t edge) { return length_of(mesh, edge); });
  const auto first_refused = lengths_m.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(lengths_m.begin(), first_refused, lengths_m.end(), std::greater<>());
  const float refused_m = *first_refused;
  edges.erase(
      std::remove_if(edges.begin(), edges.end(),
                     [&](std::uint64_t edge) { return length_of(mesh, edge) <= refused_m; }),
      edges.end());
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

using Three = std::array<std::uint32_t, 3>;

/// All sides are split: a triangle of midpoints and one at every corner.
void split_in_four(const Three& corner, const Three& middle, std::vector<Triangle>& pieces) {
  pieces.emplace_back(middle[0], middle[1], middle[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    pieces.emplace_back(corner[i], middle[i], middle[(i + 2) % 3]);
  }
}

/// Sides 0 and 1 are split: a corner is cut off, the rest divided along its shorter diagonal.
void split_in_three(const std::vector<Eigen::Vector3f>& positions, const Three& corner,
                    const Three& middle, std::vector<Triangle>& pieces) {
  pieces.emplace_back(middle[0], corner[1], middle[1]);
  const float from_first = (positions[corner[0]] - positions[middle[1]]).squaredNorm();
  const float from_last = (positions[corner[2]] - positions[middle[0]]).squaredNorm();
  if (from_first <= from_last) {
    pieces.emplace_back(corner[0], middle[0], middle[1]);
    pieces.emplace_back(corner[0], middle[1], corner[2]);
  } else {
    pieces.emplace_back(corner[0], middle[0], corner[2]);
    pieces.emplace_back(middle[0], middle[1], corner[2]);
  }
}

/// Replaces a triangle by the pieces its split sides make: 1, 2, 3 or 4.
void split(const std::vector<Eigen::Vector3f>& positions, const Triangle& triangle,
           const Midpoints& midpoints, std::vector<Triangle>& pieces) {
  Three corner{triangle[0], triangle[1], triangle[2]};
  Three middle{};  // middle[i] lies between corner i and i + 1
  int split_sides = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = midpoints.of(corner[i], corner[(i + 1) % 3]);
    split_sides += middle[i] != Midpoints::kNone ? 1 : 0;
  }
  if (split_sides == 0) return pieces.push_back(triangle);
  if (split_sides == 3) return split_in_four(corner, middle, pieces);

  // Turn the triangle until side 0 is split and side 2 is not.
  while (middle[0] == Midpoints::kNone || middle[2] != Midpoints::kNone) {
    std::rotate(corner.begin(), corner.begin() + 1, corner.end());
    std::rotate(middle.begin(), middle.begin() + 1, middle.end());
  }
  if (split_sides == 2) return split_in_three(positions, corner, middle, pieces);
  pieces.emplace_back(corner[0], middle[0], corner[2]);
  pieces.emplace_back(middle[0], corner[1], corner[2]);
}

}  // namespace

Mesh refine_mesh(const Mesh& mesh, float max_edge_m, std::size_t max_vertices) {
  assert(max_edge_m > 0 && max_vertices <= 0xffffffffU);
  Mesh refined = mesh;
  bool full = refined.positions.size() >= max_vertices;
  while (!full) {
    // Choose the edges of this round.
    const std::size_t first_new = refined.positions.size();
    const std::size_t room = max_vertices - first_new;
    std::vector<std::uint64_t> edges = long_edges(refined, max_edge_m);
    full = edges.size() > room;
    if (full) keep_longest(refined, room, edges);
    if (edges.empty()) break;

    // Halve them and cut the triangles around.
    add_midpoints(edges, refined);
    const Midpoints midpoints(edges, first_new);
    std::vector<Triangle> pieces;
    pieces.reserve(refined.triangles.size() + 2 * edges.size());
    for (const Triangle& triangle : refined.triangles) {
      split(refined.positions, triangle, midpoints, pieces);
    }
    refined.triangles = std::move(pieces);
  }
  return refined;
}

}  // namespace sheen::core
