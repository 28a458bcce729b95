// SPDX-License-Identifier: MIT
#include "core/mesh/parts.h"

#include "core/numerics/bit_key.h"

#include <Eigen/Geometry>

#include <array>
#include <numeric>
#include <unordered_map>

namespace sheen::core {
namespace {

using PositionKey = std::array<std::uint32_t, 3>;

}  // namespace

std::vector<std::uint32_t> first_at_position(const Mesh& mesh) {
  std::unordered_map<PositionKey, std::uint32_t, BitKeyHash<3>> known;
  known.reserve(mesh.positions.size());
  std::vector<std::uint32_t> first(mesh.positions.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    PositionKey key{};
    for (int axis = 0; axis < 3; ++axis) {
      key[static_cast<std::size_t>(axis)] = bits_of(mesh.positions[i][axis]);
    }
    first[i] = known.try_emplace(key, static_cast<std::uint32_t>(i)).first->second;
  }
  return first;
}

MeshParts mesh_parts(const Mesh& mesh) {
  // Union-find over positions.
  const std::vector<std::uint32_t> first = first_at_position(mesh);
  std::vector<std::uint32_t> parent(first.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root_of = [&parent](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& triangle : mesh.triangles) {
    const std::uint32_t root = root_of(first[triangle[0]]);
    parent[root_of(first[triangle[1]])] = root;
    parent[root_of(first[triangle[2]])] = root;
  }

  // Number the roots in order of their first triangle.
  constexpr std::uint32_t none = 0xffffffffU;
  std::vector<std::uint32_t> number(first.size(), none);
  MeshParts parts;
  parts.of_triangle.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    std::uint32_t& part = number[root_of(first[triangle[0]])];
    if (part == none) part = parts.count++;
    parts.of_triangle.push_back(part);
  }
  return parts;
}

Eigen::Vector3d doubled_area(const Mesh& mesh, const Eigen::Matrix<std::uint32_t, 3, 1>& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
  return (b - a).cross(c - a);
}

}  // namespace sheen::core
