// SPDX-License-Identifier: MIT
#include "fitting/billboard/directions.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace sheen::fitting::billboard {
namespace {

using SphereTriangle = std::array<Eigen::Vector3d, 3>;

std::vector<SphereTriangle> icosahedron() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::array<Eigen::Vector3d, 12> corners;
  for (int i = 0; i < 4; ++i) {
    const double a = i % 2 == 0 ? 1 : -1;
    const double b = i < 2 ? golden : -golden;
    const auto k = static_cast<std::size_t>(i);
    corners[k] = Eigen::Vector3d(a, b, 0).normalized();
    corners[4 + k] = Eigen::Vector3d(0, a, b).normalized();
    corners[8 + k] = Eigen::Vector3d(b, 0, a).normalized();
  }
  // Neighbours are those with the greatest cosine, 1 / sqrt(5); the next one is its negative.
  const auto adjoin = [&](std::size_t i, std::size_t k) {
    return corners[i].dot(corners[k]) > 0.1;
  };
  std::vector<SphereTriangle> triangles;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = i + 1; k < corners.size(); ++k) {
      for (std::size_t m = k + 1; m < corners.size(); ++m) {
        if (adjoin(i, k) && adjoin(k, m) && adjoin(i, m)) {
          triangles.push_back({corners[i], corners[k], corners[m]});
        }
      }
    }
  }
  return triangles;
}

std::vector<SphereTriangle> cut_into_four(const std::vector<SphereTriangle>& triangles) {
  std::vector<SphereTriangle> parts;
  parts.reserve(4 * triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3d ab = (a + b).normalized();
    const Eigen::Vector3d bc = (b + c).normalized();
    const Eigen::Vector3d ca = (c + a).normalized();
    parts.insert(parts.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return parts;
}

}  // namespace

std::vector<Eigen::Vector3f> directions(int count) {
  assert(std::ranges::find(kDirectionCounts, count) != kDirectionCounts.end());
  auto triangles = icosahedron();
  while (triangles.size() < static_cast<std::size_t>(count)) triangles = cut_into_four(triangles);
  std::vector<Eigen::Vector3f> centroids;
  centroids.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    centroids.emplace_back((a + b + c).normalized().cast<float>());
  }
  return centroids;
}

}  // namespace sheen::fitting::billboard
