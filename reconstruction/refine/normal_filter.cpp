// SPDX-License-Identifier: MIT
#include "reconstruction/refine/normal_filter.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sheen::reconstruction {
namespace {

/// Triangles that share a vertex with each triangle, itself left out, ascending.
struct TriangleNeighbours {
  std::vector<std::uint32_t> offsets, indices;
};

TriangleNeighbours triangle_neighbours(const core::Mesh& mesh) {
  std::vector<std::uint32_t> first(mesh.positions.size() + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) ++first[t[c] + 1];
  }
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> fans(first.back());
  std::vector<std::uint32_t> cursor(first.begin(), first.end() - 1);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    for (int c = 0; c < 3; ++c) fans[cursor[mesh.triangles[f][c]]++] = f;
  }
  TriangleNeighbours result;
  result.offsets.push_back(0);
  std::vector<std::uint32_t> row;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    row.clear();
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangles[f][c];
      row.insert(row.end(), fans.begin() + first[v], fans.begin() + first[v + 1]);
    }
    std::sort(row.begin(), row.end());
    const auto last = std::unique(row.begin(), row.end());
    std::copy_if(row.begin(), last, std::back_inserter(result.indices),
                 [f](std::uint32_t g) { return g != f; });
    result.offsets.push_back(static_cast<std::uint32_t>(result.indices.size()));
  }
  return result;
}

}  // namespace

std::vector<Eigen::Vector3f> filtered_normals(const core::Mesh& mesh, const NormalFilter& filter,
                                              int threads) {
  std::vector<Eigen::Vector3f> normals(mesh.triangles.size());
  std::vector<float> areas(normals.size());
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const auto& t = mesh.triangles[f];
    const Eigen::Vector3f n = (mesh.positions[t[1]] - mesh.positions[t[0]])
                                  .cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
    areas[f] = n.norm();
    normals[f] = areas[f] > 0 ? Eigen::Vector3f(n / areas[f]) : mesh.normals[t[0]];
  }
  const TriangleNeighbours around = triangle_neighbours(mesh);
  const float falloff = 0.5F / (filter.turn * filter.turn);
  std::vector<Eigen::Vector3f> next(normals.size());
  for (int round = 0; round < filter.rounds; ++round) {
    core::parallel_for(normals.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        Eigen::Vector3f sum = areas[f] * normals[f];
        for (std::uint32_t i = around.offsets[f]; i < around.offsets[f + 1]; ++i) {
          const std::uint32_t g = around.indices[i];
          const float turn = (normals[g] - normals[f]).squaredNorm();
          sum += areas[g] * std::exp(-falloff * turn) * normals[g];
        }
        const float length = sum.norm();
        next[f] = length > 0 ? Eigen::Vector3f(sum / length) : normals[f];
      }
    });
    normals.swap(next);
  }
  return normals;
}

}  // namespace sheen::reconstruction
