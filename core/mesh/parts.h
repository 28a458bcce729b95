// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <cstdint>
#include <vector>

namespace sheen::core {

/// For every vertex the first one that has exactly its position.
std::vector<std::uint32_t> first_at_position(const Mesh& mesh);

/// The connected parts of a surface: triangles that share a position belong together.
struct MeshParts {
  std::vector<std::uint32_t> of_triangle;  ///< part of every triangle, counted from 0
  std::uint32_t count = 0;
};
MeshParts mesh_parts(const Mesh& mesh);

/// Cross product of two edges: twice the area along the normal.
Eigen::Vector3d doubled_area(const Mesh& mesh, const Eigen::Matrix<std::uint32_t, 3, 1>& triangle);

}  // namespace sheen::core
