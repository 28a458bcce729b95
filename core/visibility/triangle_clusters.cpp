// SPDX-License-Identifier: MIT
#include "core/visibility/triangle_clusters.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace sheen::core {
namespace {

/// Distance between the bits of ten-bit numbers, for a space-filling curve.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000FFu;
  x = (x | (x << 8)) & 0x0300F00Fu;
  x = (x | (x << 4)) & 0x030C30C3u;
  return (x | (x << 2)) & 0x09249249u;
}

Eigen::Vector3f centroid(const Mesh& mesh, std::size_t triangle_idx) {
  const auto& triangle = mesh.triangles[triangle_idx];
  return (mesh.positions[triangle[0]] + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]) /
         3.0f;
}

/// Not of unit length; zero for a triangle without area.
Eigen::Vector3f face_normal(const Mesh& mesh, std::size_t triangle_idx) {
  const auto& triangle = mesh.triangles[triangle_idx];
  const Eigen::Vector3f& a = mesh.positions[triangle[0]];
  return (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
}

/// Triangle indices along Morton's curve through their centroids.
std::vector<std::uint32_t> spatial_order(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
  const float cells_per_m = 1023.0f / std::max(box.sizes().maxCoeff(), 1e-30f);
  std::vector<std::uint32_t> keys(mesh.triangles.size());
  for (std::size_t t = 0; t < keys.size(); ++t) {
    const Eigen::Vector3f cell = (centroid(mesh, t) - box.min()) * cells_per_m;
    for (int axis = 0; axis < 3; ++axis) {
      keys[t] |= spread_bits(static_cast<std::uint32_t>(std::clamp(cell[axis], 0.0f, 1023.0f)))
                 << axis;
    }
  }
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

}  // namespace

TriangleClusters::TriangleClusters(const Mesh& mesh) {
  const std::vector<std::uint32_t> order = spatial_order(mesh);
  const std::size_t clusters = (order.size() + kTriangles - 1) / kTriangles;
  bounds_.reserve(clusters);
  for (auto& corner : corners_) corner.assign(clusters * kTriangles, 0u);
  for (std::size_t first = 0; first < order.size(); first += kTriangles) {
    const std::size_t count = std::min(kTriangles, order.size() - first);
    bounds_.push_back(bounds_of(mesh, order.data() + first, count));
    for (std::size_t t = first; t < first + count; ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        corners_[corner][t] = mesh.triangles[order[t]][corner];
      }
    }
  }
}

TriangleClusters::Bounds TriangleClusters::bounds_of(const Mesh& mesh,
                                                     const std::uint32_t* triangles,
                                                     std::size_t count) {
  // The ball about the box's centre.
  Eigen::AlignedBox3f box;
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::uint32_t vertex : mesh.triangles[triangles[i]]) {
      box.extend(mesh.positions[vertex]);
    }
    axis += face_normal(mesh, triangles[i]).normalized();
  }
  Bounds bounds{box.center(), 0.5f * box.diagonal().norm(), axis.normalized(), 2.0f};
  // The cone about the mean normal; a little wider, against rounding.
  float cosine = 1.0f;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f normal = face_normal(mesh, triangles[i]);
    if (normal.squaredNorm() > 0.0f)
      cosine = std::min(cosine, bounds.axis.dot(normal.normalized()));
  }
  cosine -= 1e-3f;
  if (cosine > 0.0f) bounds.sine = std::sqrt(1.0f - cosine * cosine);
  return bounds;
}

bool TriangleClusters::faces_away(std::size_t cluster_idx, const Eigen::Vector3f& eye) const {
  // A triangle with normal n and a corner p shows its back where n . (p - eye) >= 0. For n in the
  // cone and p in the ball that is at least |centre - eye| cos(a + h) - radius, with a between the
  // axis and the line of sight and h half the cone's opening.
  const Bounds& bounds = bounds_[cluster_idx];
  if (bounds.sine > 1.0f) return false;
  const Eigen::Vector3f away = bounds.centre - eye;
  const float along = away.dot(bounds.axis);
  const float across = std::sqrt(std::max(0.0f, away.squaredNorm() - along * along));
  const float cosine = std::sqrt(1.0f - bounds.sine * bounds.sine);
  return along * cosine - across * bounds.sine >= bounds.radius_m;
}

}  // namespace sheen::core
