// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace sheen::core {

/// Triangle mesh in the object frame, metres. Every vertex is a patch of the light field.
/// Invariants of a mesh that `read_mesh` returns: positions are finite, normals have unit length
/// (also at vertices no triangle uses), triangles index valid, distinct vertices.
struct Mesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Matrix<std::uint32_t, 3, 1>>
      triangles;  ///< counter-clockwise seen from outside
  /// What was taken out of the file's coordinates before they were rounded to single precision:
  /// file = position + offset. Zero unless the mesh lies far from its origin, as survey coordinates
  /// do.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

}  // namespace sheen::core
