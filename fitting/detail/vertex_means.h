// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "fitting/detail/texel_means.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// The colours at the vertices that, interpolated across the triangles, come nearest to what a view
/// shows of the surface. What lies between vertices averages out of them, and with it what small
/// errors of pose and mesh make of print; a texture that has the print needs from the vertices only
/// what changes with direction.
class VertexMeans {
 public:
  /// `mesh` outlives it.
  VertexMeans(const core::Mesh& mesh, int threads);

  /// Replaces the colours of a view's samples by these. `triangles` has an entry per triangle, that
  /// counts where it is a front in `raster`.
  /// Samples with less than about one texel around them stay as they are. The same on any number of
  /// threads.
  void average(const ViewRaster& raster, std::span<const CornerColours> triangles,
               core::SampleBatch& samples);

 private:
  struct Corner {
    std::uint32_t triangle_idx;
    std::uint32_t corner;
  };

  /// Calls `body(vertex)` for all of them.
  template <typename Body>
  void for_vertices(const Body& body) const;
  [[nodiscard]] std::span<const Corner> corners_at(std::size_t vertex) const {
    return {corners_.data() + offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]};
  }

  const core::Mesh& mesh_;
  int threads_;
  std::vector<std::uint32_t> offsets_;
  std::vector<Corner> corners_;      ///< those at vertex i: [offsets_[i], offsets_[i + 1])
  std::vector<float> weight_;        ///< of the texels around a vertex
  std::vector<Four> colour_, next_;  ///< R, G and B in the last three places
};

}  // namespace sheen::fitting::detail
