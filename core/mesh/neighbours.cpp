// SPDX-License-Identifier: MIT
#include "core/mesh/neighbours.h"

#include <algorithm>

namespace sheen::core {
namespace {

/// Both directions of every triangle's edges, in rows per vertex; inner edges appear twice.
VertexNeighbours repeated_neighbours(const Mesh& mesh) {
  VertexNeighbours rows;
  rows.offsets.assign(mesh.positions.size() + 1, 0);
  for (const auto& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) rows.offsets[triangle[corner] + 1] += 2;
  }
  for (std::size_t i = 1; i < rows.offsets.size(); ++i) rows.offsets[i] += rows.offsets[i - 1];
  rows.indices.resize(rows.offsets.back());
  std::vector<std::uint32_t> cursor(rows.offsets.begin(), rows.offsets.end() - 1);
  for (const auto& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      std::uint32_t& place = cursor[triangle[corner]];
      rows.indices[place++] = triangle[(corner + 1) % 3];
      rows.indices[place++] = triangle[(corner + 2) % 3];
    }
  }
  return rows;
}

}  // namespace

VertexNeighbours vertex_neighbours(const Mesh& mesh) {
  VertexNeighbours rows = repeated_neighbours(mesh);
  // Sort every row, drop repeats, close the gaps that leaves.
  auto write = rows.indices.begin();
  auto begin = rows.indices.begin();
  for (std::size_t i = 0; i + 1 < rows.offsets.size(); ++i) {
    const auto end = rows.indices.begin() + rows.offsets[i + 1];
    std::sort(begin, end);
    const auto row_begin = write;
    write = std::copy(begin, std::unique(begin, end), write);
    rows.offsets[i] = static_cast<std::uint32_t>(row_begin - rows.indices.begin());
    begin = end;
  }
  rows.offsets.back() = static_cast<std::uint32_t>(write - rows.indices.begin());
  rows.indices.erase(write, rows.indices.end());
  rows.indices.shrink_to_fit();
  return rows;
}

}  // namespace sheen::core
