// SPDX-License-Identifier: MIT
#include "core/atlas/atlas_vertices.h"

#include <cstddef>
#include <limits>
#include <numeric>

namespace sheen::core {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

AtlasVertices split_at_seams(const Mesh& mesh, const Atlas& atlas) {
  AtlasVertices split;
  const std::size_t count = mesh.positions.size();
  split.vertex.resize(count);
  std::iota(split.vertex.begin(), split.vertex.end(), 0u);
  split.place.resize(count);
  split.triangles = mesh.triangles;
  std::vector<std::uint8_t> is_placed(count, 0);
  std::vector<std::uint32_t> next_copy(count, kNone);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      const AtlasPoint& place = atlas.corners[t][static_cast<std::size_t>(corner)];
      std::uint32_t found = mesh.triangles[t][corner];
      if (is_placed[found] == 0) {
        is_placed[found] = 1;
        split.place[found] = place;
      }
      // Walk along the copies made so far.
      while (split.place[found] != place) {
        if (next_copy[found] == kNone) {
          next_copy[found] = static_cast<std::uint32_t>(split.vertex.size());
          split.vertex.push_back(mesh.triangles[t][corner]);
          split.place.push_back(place);
          next_copy.push_back(kNone);
        }
        found = next_copy[found];
      }
      split.triangles[t][corner] = found;
    }
  }
  return split;
}

std::vector<std::array<AtlasPoint, 3>> corners_of(const std::vector<AtlasPoint>& places,
                                                  const decltype(Mesh::triangles)& triangles) {
  std::vector<std::array<AtlasPoint, 3>> corners;
  corners.reserve(triangles.size());
  for (const auto& triangle : triangles) {
    corners.push_back({places[triangle[0]], places[triangle[1]], places[triangle[2]]});
  }
  return corners;
}

}  // namespace sheen::core
