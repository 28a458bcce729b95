// SPDX-License-Identifier: MIT
#include "reconstruction/surface/self_intersection.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/surface/edge_mesh.h"
#include "reconstruction/surface/triangle_tree.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <stdexcept>

namespace sheen::reconstruction {
namespace {

using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;
using Corners = std::array<Eigen::Vector3d, 3>;

constexpr double kFolded = -0.9999;  // cosine between neighbours that lie on each other

Corners corners_of(const core::Mesh& mesh, const Triangle& triangle) {
  return {mesh.positions[triangle[0]].cast<double>(), mesh.positions[triangle[1]].cast<double>(),
          mesh.positions[triangle[2]].cast<double>()};
}

double volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether the segment p q passes through the inside of a triangle.
bool passes(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Corners& t) {
  const double above = volume(t[0], t[1], t[2], p);
  const double below = volume(t[0], t[1], t[2], q);
  if (!(above * below < 0)) return false;
  const double a = volume(p, q, t[0], t[1]);
  const double b = volume(p, q, t[1], t[2]);
  const double c = volume(p, q, t[2], t[0]);
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

bool holds(const Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

bool cross(const core::Mesh& mesh, const Triangle& s, const Triangle& t) {
  const Corners a = corners_of(mesh, s);
  const Corners b = corners_of(mesh, t);
  const int shared = static_cast<int>(holds(t, s[0])) + static_cast<int>(holds(t, s[1])) +
                     static_cast<int>(holds(t, s[2]));
  if (shared == 3) return true;
  if (shared == 2) {
    const Eigen::Vector3d m = (a[1] - a[0]).cross(a[2] - a[0]).normalized();
    const Eigen::Vector3d n = (b[1] - b[0]).cross(b[2] - b[0]).normalized();
    return m.dot(n) < kFolded;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const auto u = static_cast<std::size_t>(i);
    const auto v = static_cast<std::size_t>(j);
    // An edge that ends at a shared vertex touches there and cannot pass but along the plane.
    if (!holds(t, s[i]) && !holds(t, s[j]) && passes(a[u], a[v], b)) return true;
    if (!holds(s, t[i]) && !holds(s, t[j]) && passes(b[u], b[v], a)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> find_self_intersections(const core::Mesh& mesh,
                                                                             int threads) {
  const TriangleTree tree(mesh);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  std::mutex mutex;
  core::parallel_for(mesh.triangles.size(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> own;
    for (std::size_t i = begin; i < end; ++i) {
      const auto first = static_cast<std::uint32_t>(i);
      Eigen::AlignedBox3f box;
      for (int corner = 0; corner < 3; ++corner) {
        box.extend(mesh.positions[mesh.triangles[i][corner]]);
      }
      tree.for_each_in(box, [&](std::uint32_t second) {
        if (second > first && cross(mesh, mesh.triangles[first], mesh.triangles[second])) {
          own.emplace_back(first, second);
        }
      });
    }
    const std::lock_guard lock(mutex);
    found.insert(found.end(), own.begin(), own.end());
  });
  std::sort(found.begin(), found.end());
  return found;
}

bool is_closed_manifold(const core::Mesh& mesh) {
  try {
    const EdgeMesh edges(mesh);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace sheen::reconstruction
