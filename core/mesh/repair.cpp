// SPDX-License-Identifier: MIT
#include "core/mesh/repair.h"

#include "core/mesh/parts.h"
#include "core/numerics/bit_key.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace sheen::core {
namespace {

using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;

/// Bit patterns of a position and, where they matter, a normal and a colour.
using VertexKey = std::array<std::uint32_t, 9>;

VertexKey key_of(const Eigen::Vector3f& position, const Eigen::Vector3f& normal,
                 const Eigen::Vector3f& colour) {
  VertexKey key{};
  for (int axis = 0; axis < 3; ++axis) {
    key[static_cast<std::size_t>(axis)] = bits_of(position[axis]);
    key[static_cast<std::size_t>(axis) + 3] = bits_of(normal[axis]);
    key[static_cast<std::size_t>(axis) + 6] = bits_of(colour[axis]);
  }
  return key;
}

/// Enclosed volume of a closed surface, m^3, by the divergence theorem.
double signed_volume(const Mesh& mesh) {
  const Eigen::Vector3d origin = mesh.positions.front().cast<double>();
  double sixfold = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d corner = mesh.positions[triangle[0]].cast<double>() - origin;
    sixfold += corner.dot(doubled_area(mesh, triangle));
  }
  return sixfold / 6;
}

bool is_usable(const Eigen::Vector3f& normal) {
  const float squared = normal.squaredNorm();
  return std::isfinite(squared) && squared > 1e-12f;
}

/// Angle-weighted sums of triangle normals per vertex.
std::vector<Eigen::Vector3d> normal_sums(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> sums(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d area = doubled_area(mesh, triangle);
    const double length = area.norm();
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d apex = mesh.positions[triangle[corner]].cast<double>();
      const Eigen::Vector3d left = mesh.positions[triangle[(corner + 1) % 3]].cast<double>() - apex;
      const Eigen::Vector3d right =
          mesh.positions[triangle[(corner + 2) % 3]].cast<double>() - apex;
      const double angle = std::atan2(length, left.dot(right));
      sums[triangle[corner]] += angle / length * area;
    }
  }
  return sums;
}

}  // namespace

bool is_closed(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_position(mesh);
  // Collect every directed edge and its mirror image, each as one number.
  std::vector<std::uint64_t> edges;
  std::vector<std::uint64_t> mirrored;
  for (const Triangle& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint64_t from = first[triangle[corner]];
      const std::uint64_t to = first[triangle[(corner + 1) % 3]];
      edges.push_back(from << 32 | to);
      mirrored.push_back(to << 32 | from);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(mirrored.begin(), mirrored.end());
  return edges == mirrored && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

void join_identical_vertices(Mesh& mesh, std::vector<Eigen::Vector3f>& colours) {
  const auto at = [](const std::vector<Eigen::Vector3f>& of, std::uint32_t vertex) {
    return of.empty() ? Eigen::Vector3f(Eigen::Vector3f::Zero()) : of[vertex];
  };
  std::unordered_map<VertexKey, std::uint32_t, BitKeyHash<9>> known;
  Mesh joined;
  std::vector<Eigen::Vector3f> joined_colours;
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      const Eigen::Vector3f& position = mesh.positions[corner];
      const Eigen::Vector3f normal = at(mesh.normals, corner);
      const Eigen::Vector3f colour = at(colours, corner);
      const auto next = static_cast<std::uint32_t>(joined.positions.size());
      const auto [entry, is_new] = known.try_emplace(key_of(position, normal, colour), next);
      corner = entry->second;
      if (!is_new) continue;
      joined.positions.push_back(position);
      if (!mesh.normals.empty()) joined.normals.push_back(normal);
      if (!colours.empty()) joined_colours.push_back(colour);
    }
  }
  mesh.positions = std::move(joined.positions);
  mesh.normals = std::move(joined.normals);
  colours = std::move(joined_colours);
}

void drop_degenerate_triangles(Mesh& mesh) {
  std::erase_if(mesh.triangles, [&mesh](const Triangle& triangle) {
    return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0] ||
           !(doubled_area(mesh, triangle).squaredNorm() > 0);
  });
}

void turn_inside_out_surface(Mesh& mesh) {
  if (mesh.triangles.empty() || signed_volume(mesh) >= 0 || !is_closed(mesh)) return;
  // Normals that agree with the wrong winding are wrong, too; those that oppose it are right.
  double agreement = 0;
  if (!mesh.normals.empty()) {
    for (const Triangle& triangle : mesh.triangles) {
      const Eigen::Vector3d area = doubled_area(mesh, triangle);
      for (const std::uint32_t corner : triangle) {
        if (is_usable(mesh.normals[corner])) {
          agreement += area.dot(mesh.normals[corner].cast<double>());
        }
      }
    }
  }
  if (agreement > 0) {
    for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
  }
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

void complete_normals(Mesh& mesh) {
  mesh.normals.resize(mesh.positions.size(), Eigen::Vector3f::Zero());
  std::vector<std::uint8_t> missing(mesh.positions.size(), 0);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    missing[i] = !is_usable(mesh.normals[i]);
    if (!missing[i]) mesh.normals[i].normalize();
  }
  if (std::find(missing.begin(), missing.end(), 1) == missing.end()) return;

  // Sum over the triangles around.
  const std::vector<Eigen::Vector3d> sums = normal_sums(mesh);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!missing[i]) continue;
    mesh.normals[i] = Eigen::Vector3f::UnitZ();
    if (sums[i].norm() > 1e-6) {
      mesh.normals[i] = sums[i].normalized().cast<float>();
      missing[i] = 0;
    }
  }
  // Triangles that cancel out, a leaf seen from both sides: let one of them decide.
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (!missing[corner]) continue;
      mesh.normals[corner] = doubled_area(mesh, triangle).normalized().cast<float>();
      missing[corner] = 0;
    }
  }
}

}  // namespace sheen::core
