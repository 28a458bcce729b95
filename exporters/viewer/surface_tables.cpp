// SPDX-License-Identifier: MIT
#include "exporters/viewer/surface_tables.h"

#include "core/mesh/bounds.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sheen::exporters::viewer {
namespace {

constexpr float kSteps = 65535.0f;

/// Positions in whole steps from the lowest corner of the box, 65535 of them along its longest
/// side.
struct Grid {
  Eigen::Vector3f lowest;
  float step;

  explicit Grid(const core::Mesh& mesh) {
    const Eigen::AlignedBox3f box = core::bounds_of(mesh);
    lowest = box.min();
    step = std::max(box.sizes().maxCoeff() / kSteps, 1e-30f);
  }
  [[nodiscard]] Eigen::Vector3i steps_to(const Eigen::Vector3f& position) const {
    return ((position - lowest) / step).array().round().cast<int>();
  }
  [[nodiscard]] Eigen::Vector3f position_at(const Eigen::Vector3i& steps) const {
    return lowest + step * steps.cast<float>();
  }
};

/// A normal projected onto the octahedron |x| + |y| + |z| = 1: x and y in 65534 steps from -1 to 1,
/// and whether z has its sign bit set. The sign must survive even where z is zero, because the
/// tangent frame jumps there (core/geometry/tangent_frame.h).
std::array<std::int32_t, 3> octahedral(const Eigen::Vector3f& normal) {
  const Eigen::Vector3f n = normal / normal.cwiseAbs().sum();
  const auto steps = [](float x) {
    return static_cast<std::int32_t>(std::lround((x + 1.0f) * 32767.0f));
  };
  return {steps(n.x()), steps(n.y()), std::signbit(normal.z()) ? 1 : 0};
}

Eigen::Vector3f normal_of(const std::array<std::int32_t, 3>& code) {
  const float x = static_cast<float>(code[0]) / 32767.0f - 1.0f;
  const float y = static_cast<float>(code[1]) / 32767.0f - 1.0f;
  const float z = std::max(1.0f - std::abs(x) - std::abs(y), 0.0f);
  return Eigen::Vector3f(x, y, std::copysign(z, code[2] != 0 ? -1.0f : 1.0f)).normalized();
}

}  // namespace

nlohmann::json add_surface(const core::Mesh& mesh, const core::AtlasVertices* split,
                           PackedArrays& tables) {
  // Vertices.
  const Grid grid(mesh);
  std::vector<std::int32_t> positions;
  std::vector<std::int32_t> normals;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3i steps = grid.steps_to(mesh.positions[i]);
    positions.insert(positions.end(), steps.begin(), steps.end());
    const auto code = octahedral(mesh.normals[i]);
    normals.insert(normals.end(), code.begin(), code.end());
  }
  tables.add("positions", positions, 3, 2);
  tables.add("normals", normals, 3, 2);

  // Places on the texture, and the vertices that its seams repeat.
  if (split != nullptr) {
    std::vector<std::int32_t> places;
    for (const core::AtlasPoint& place : split->place) {
      places.push_back(place.u);
      places.push_back(place.v);
    }
    const std::vector<std::int32_t> copies(
        split->vertex.begin() + static_cast<std::ptrdiff_t>(mesh.positions.size()),
        split->vertex.end());
    tables.add("places", places, 2, 2);
    tables.add("copies", copies, 1, 4);
  }

  // Triangles.
  const auto& triangles = split != nullptr ? split->triangles : mesh.triangles;
  std::vector<std::int32_t> corners;
  for (const auto& triangle : triangles) {
    for (const std::uint32_t vertex : triangle)
      corners.push_back(static_cast<std::int32_t>(vertex));
  }
  tables.add("triangles", corners, 3, 4);
  return {{"lowest",
           {static_cast<double>(grid.lowest.x()), static_cast<double>(grid.lowest.y()),
            static_cast<double>(grid.lowest.z())}},
          {"step", static_cast<double>(grid.step)}};
}

core::Mesh rounded_surface(const core::Mesh& mesh) {
  const Grid grid(mesh);
  core::Mesh result = mesh;
  for (Eigen::Vector3f& position : result.positions) {
    position = grid.position_at(grid.steps_to(position));
  }
  for (Eigen::Vector3f& normal : result.normals) normal = normal_of(octahedral(normal));
  return result;
}

}  // namespace sheen::exporters::viewer
