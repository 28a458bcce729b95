// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sheen::core {

/// Which vertices share an edge, in compressed rows: the neighbours of vertex i are
/// `indices[offsets[i] .. offsets[i + 1])`, ascending.
struct VertexNeighbours {
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> indices;

  [[nodiscard]] std::size_t vertex_count() const {
    return offsets.empty() ? 0 : offsets.size() - 1;
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t vertex_idx) const {
    return {indices.data() + offsets[vertex_idx], offsets[vertex_idx + 1] - offsets[vertex_idx]};
  }
};

VertexNeighbours vertex_neighbours(const Mesh& mesh);

}  // namespace sheen::core
