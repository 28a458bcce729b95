// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "fitting/detail/texel_means.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// The colour of a view around every vertex: mean over the texels of the triangles there, each
/// weighted with the vertex's barycentric weight. What lies between vertices averages out of it,
/// and with it what small errors of pose and mesh make of print; a texture that has the print needs
/// from the vertices only what changes with direction.
class VertexMeans {
 public:
  explicit VertexMeans(const core::Mesh& mesh);

  /// Replaces the colours of a view's samples by means. `triangles` has an entry per triangle.
  /// Samples with less than about one texel around them stay as they are.
  void average(std::span<const CornerColours> triangles, core::SampleBatch& samples) const;

 private:
  struct Corner {
    std::uint32_t triangle_idx;
    std::uint32_t corner;
  };

  std::vector<std::uint32_t> offsets_;
  std::vector<Corner> corners_;  ///< those at vertex i: [offsets_[i], offsets_[i + 1])
};

}  // namespace sheen::fitting::detail
