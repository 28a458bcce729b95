// SPDX-License-Identifier: MIT
#include "core/mesh/triangle_neighbours.h"

#include "core/mesh/parts.h"

#include <algorithm>
#include <tuple>

namespace sheen::core {
namespace {

/// A side of a triangle; equal `key` for both triangles at an edge.
struct TriangleEdge {
  std::uint64_t key;
  std::uint32_t triangle_idx;
  std::uint32_t side;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const Mesh& mesh) {
  // List the sides, those of one edge together.
  const std::vector<std::uint32_t> joined = first_at_position(mesh);
  std::vector<TriangleEdge> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t side = 0; side < 3; ++side) {
      const std::uint64_t a = joined[mesh.triangles[t][side]];
      const std::uint64_t b = joined[mesh.triangles[t][(side + 1) % 3]];
      sides.push_back({std::min(a, b) << 32U | std::max(a, b), t, side});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const TriangleEdge& a, const TriangleEdge& b) {
    return std::tie(a.key, a.triangle_idx, a.side) < std::tie(b.key, b.triangle_idx, b.side);
  });

  // Join the first two of each edge.
  std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(),
                                                       {kNoTriangle, kNoTriangle, kNoTriangle});
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    const TriangleEdge& first = sides[begin];
    if (end - begin >= 2 && sides[begin + 1].triangle_idx != first.triangle_idx) {
      const TriangleEdge& second = sides[begin + 1];
      neighbours[first.triangle_idx][first.side] = second.triangle_idx;
      neighbours[second.triangle_idx][second.side] = first.triangle_idx;
    }
    begin = end;
  }
  return neighbours;
}

}  // namespace sheen::core
