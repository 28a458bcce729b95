// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace sheen::core {

/// Size and orientation of every triangle of a mesh.
struct TriangleShapes {
  std::vector<Eigen::Vector3f> normal;  ///< unit; zero where the triangle has no area
  std::vector<float> area_m2;
};

inline TriangleShapes triangle_shapes(const Mesh& mesh) {
  TriangleShapes shapes;
  shapes.normal.reserve(mesh.triangles.size());
  shapes.area_m2.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.positions[triangle[0]];
    const Eigen::Vector3f cross =
        (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    const float length = cross.norm();
    shapes.area_m2.push_back(0.5f * length);
    shapes.normal.push_back(length > 0.0f ? Eigen::Vector3f(cross / length)
                                          : Eigen::Vector3f(Eigen::Vector3f::Zero()));
  }
  return shapes;
}

}  // namespace sheen::core
