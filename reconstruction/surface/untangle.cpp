// SPDX-License-Identifier: MIT
#include "reconstruction/surface/untangle.h"

#include "core/mesh/repair.h"
#include "reconstruction/surface/self_intersection.h"

#include <cstdint>
#include <vector>

namespace sheen::reconstruction {
namespace {

constexpr int kUntangleRounds = 24;

}  // namespace

bool untangle(core::Mesh& mesh, int threads) {
  for (int round = 0; round < kUntangleRounds; ++round) {
    const auto pairs = find_self_intersections(mesh, threads);
    if (pairs.empty()) return true;
    std::vector<std::uint8_t> tangled(mesh.positions.size(), 0);
    for (const auto& [s, t] : pairs) {
      for (int c = 0; c < 3; ++c) {
        tangled[mesh.triangles[s][c]] = 1;
        tangled[mesh.triangles[t][c]] = 1;
      }
    }
    // Those that do not come apart need more room.
    for (int ring = 0; ring < round / 3; ++ring) {
      const std::vector<std::uint8_t> before = tangled;
      for (const auto& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) tangled[t[c]] |= before[t[(c + 1) % 3]];
      }
    }
    std::vector<Eigen::Vector3f> sum(mesh.positions.size(), Eigen::Vector3f::Zero());
    std::vector<float> count(mesh.positions.size(), 0);
    for (const auto& t : mesh.triangles) {
      for (int c = 0; c < 3; ++c) {
        sum[t[c]] += mesh.positions[t[(c + 1) % 3]];
        count[t[c]] += 1;
      }
    }
    for (std::size_t i = 0; i < tangled.size(); ++i) {
      if (tangled[i] != 0) mesh.positions[i] = sum[i] / count[i];
    }
    mesh.normals.clear();
    core::complete_normals(mesh);
  }
  return find_self_intersections(mesh, threads).empty();
}

}  // namespace sheen::reconstruction
