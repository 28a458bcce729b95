// SPDX-License-Identifier: MIT
#include "core/samples/surface_points.h"

namespace sheen::core {

SurfacePoints surface_points(const Mesh& mesh) {
  SurfacePoints points;
  const std::size_t count = mesh.positions.size();
  for (auto* column : {&points.x, &points.y, &points.z}) column->reserve(count);
  for (const Eigen::Vector3f& position : mesh.positions) {
    points.x.push_back(position.x());
    points.y.push_back(position.y());
    points.z.push_back(position.z());
  }
  for (auto* column : {&points.nx, &points.ny, &points.nz}) column->assign(count, 0.0f);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t i : triangle) {
      points.nx[i] = mesh.normals[i].x();
      points.ny[i] = mesh.normals[i].y();
      points.nz[i] = mesh.normals[i].z();
    }
  }
  return points;
}

}  // namespace sheen::core
