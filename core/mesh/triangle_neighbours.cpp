// SPDX-License-Identifier: MIT
#include "core/mesh/triangle_neighbours.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace sheen::core {
namespace {

/// A side of a triangle; equal `key` for both triangles at an edge.
struct TriangleEdge {
  std::uint64_t key;
  std::uint32_t triangle_idx;
  std::uint32_t side;
};

/// For every vertex the first one, in the order of positions, that stands at its place.
std::vector<std::uint32_t> joined_by_position(const std::vector<Eigen::Vector3f>& positions) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const auto& p = positions[a];
    const auto& q = positions[b];
    return std::tie(p.x(), p.y(), p.z(), a) < std::tie(q.x(), q.y(), q.z(), b);
  };
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> joined(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    joined[order[i]] = same ? joined[order[i - 1]] : order[i];
  }
  return joined;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const Mesh& mesh) {
  // List the sides, those of one edge together.
  const std::vector<std::uint32_t> joined = joined_by_position(mesh.positions);
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
