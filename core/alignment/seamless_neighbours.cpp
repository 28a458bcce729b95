// SPDX-License-Identifier: MIT
#include "core/alignment/seamless_neighbours.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace sheen::core {
namespace {

/// Pairs (vertex, vertex at the same position), both ways, ascending.
std::vector<std::pair<std::uint32_t, std::uint32_t>> coincident_pairs(const Mesh& mesh) {
  const auto key = [&](std::uint32_t i) {
    const Eigen::Vector3f& p = mesh.positions[i];
    return std::array<float, 3>{p.x(), p.y(), p.z()};
  };
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  // Chain each group into a line: enough for a walk, and linear however large the group is.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i - 1]) != key(order[i])) continue;
    pairs.emplace_back(order[i - 1], order[i]);
    pairs.emplace_back(order[i], order[i - 1]);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

VertexNeighbours seamless_neighbours(const Mesh& mesh) {
  const VertexNeighbours edges = vertex_neighbours(mesh);
  const auto pairs = coincident_pairs(mesh);
  VertexNeighbours result;
  result.offsets.assign(1, 0);
  result.offsets.reserve(mesh.positions.size() + 1);
  result.indices.reserve(edges.indices.size() + pairs.size());
  auto pair = pairs.begin();
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(result.indices.size());
    const auto row = edges.of(i);
    result.indices.insert(result.indices.end(), row.begin(), row.end());
    for (; pair != pairs.end() && pair->first == i; ++pair) result.indices.push_back(pair->second);
    std::sort(result.indices.begin() + first, result.indices.end());
    result.offsets.push_back(static_cast<std::uint32_t>(result.indices.size()));
  }
  return result;
}

}  // namespace sheen::core
