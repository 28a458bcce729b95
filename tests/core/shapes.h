// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace sheen::core::testing {

/// A grid of squares in the plane z, side 2 * half_side around the z axis, facing +z.
inline Mesh square_grid(int cells, float half_side, float z) {
  Mesh mesh;
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j < row; ++j) {
    for (std::uint32_t i = 0; i < row; ++i) {
      const float step = 2 * half_side / static_cast<float>(cells);
      mesh.positions.emplace_back(-half_side + step * static_cast<float>(i),
                                  -half_side + step * static_cast<float>(j), z);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
    }
  }
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      mesh.triangles.emplace_back(a, a + 1, a + row + 1);
      mesh.triangles.emplace_back(a, a + row + 1, a + row);
    }
  }
  return mesh;
}

/// Unit sphere from rings of latitude with a vertex at either pole.
inline Mesh sphere(int rings, int sectors) {
  Mesh mesh;
  mesh.positions.emplace_back(0.0f, 0.0f, 1.0f);
  for (int ring = 1; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const double theta = std::numbers::pi * ring / rings;
      const double phi = 2 * std::numbers::pi * sector / sectors;
      mesh.positions.emplace_back(static_cast<float>(std::sin(theta) * std::cos(phi)),
                                  static_cast<float>(std::sin(theta) * std::sin(phi)),
                                  static_cast<float>(std::cos(theta)));
    }
  }
  mesh.positions.emplace_back(0.0f, 0.0f, -1.0f);
  mesh.normals = mesh.positions;
  const auto vertex = [&](int ring, int sector) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * sectors + sector % sectors);
  };
  const auto south = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int sector = 0; sector < sectors; ++sector) {
    mesh.triangles.emplace_back(0u, vertex(1, sector), vertex(1, sector + 1));
    mesh.triangles.emplace_back(south, vertex(rings - 1, sector + 1), vertex(rings - 1, sector));
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.emplace_back(vertex(ring, sector), vertex(ring + 1, sector),
                                  vertex(ring + 1, sector + 1));
      mesh.triangles.emplace_back(vertex(ring, sector), vertex(ring + 1, sector + 1),
                                  vertex(ring, sector + 1));
    }
  }
  return mesh;
}

/// `second` after `first`, as one mesh.
inline Mesh together(const Mesh& first, const Mesh& second) {
  Mesh mesh = first;
  const auto base = static_cast<std::uint32_t>(first.positions.size());
  mesh.positions.insert(mesh.positions.end(), second.positions.begin(), second.positions.end());
  mesh.normals.insert(mesh.normals.end(), second.normals.begin(), second.normals.end());
  for (const auto& triangle : second.triangles) {
    mesh.triangles.emplace_back(triangle[0] + base, triangle[1] + base, triangle[2] + base);
  }
  return mesh;
}

/// Of all triangles together.
inline double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    area += 0.5 * static_cast<double>((mesh.positions[t[1]] - mesh.positions[t[0]])
                                          .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                                          .norm());
  }
  return area;
}

/// camera_from_object of a camera at z = `height` that looks down, its x along the object's.
inline Eigen::Isometry3d camera_above(double height) {
  Eigen::Isometry3d camera_from_object = Eigen::Isometry3d::Identity();
  camera_from_object.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera_from_object.translation() = Eigen::Vector3d(0, 0, height);
  return camera_from_object;
}

}  // namespace sheen::core::testing
