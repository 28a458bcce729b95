// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <cstddef>

namespace sheen::core {

/// Place on a triangle, object frame. `barycentric`: weights of its corners, of sum 1.
inline Eigen::Vector3f place_on(const Mesh& mesh, std::size_t triangle,
                                const Eigen::Vector3f& barycentric) {
  const auto& corner = mesh.triangles[triangle];
  return barycentric[0] * mesh.positions[corner[0]] + barycentric[1] * mesh.positions[corner[1]] +
         barycentric[2] * mesh.positions[corner[2]];
}

/// Unit normal there: the corners', interpolated; that of a corner where they cancel out.
inline Eigen::Vector3f normal_on(const Mesh& mesh, std::size_t triangle,
                                 const Eigen::Vector3f& barycentric) {
  const auto& corner = mesh.triangles[triangle];
  const Eigen::Vector3f sum = barycentric[0] * mesh.normals[corner[0]] +
                              barycentric[1] * mesh.normals[corner[1]] +
                              barycentric[2] * mesh.normals[corner[2]];
  const float length = sum.norm();
  return length > 1e-6f ? Eigen::Vector3f(sum / length) : mesh.normals[corner[0]];
}

}  // namespace sheen::core
