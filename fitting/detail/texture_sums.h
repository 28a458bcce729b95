// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "fitting/detail/texel_sums.h"
#include "fitting/detail/view_raster.h"
#include "fitting/huge_pages.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// The sums of all texels of an atlas over the pixels of all views so far.
class TextureSums {
 public:
  /// `mesh` and `atlas`, one of its, outlive it.
  TextureSums(const core::Mesh& mesh, const core::Atlas& atlas, int threads);

  /// Adds the pixels of a view. The same on any number of threads.
  void integrate(const core::Observation& observation, const ViewRaster& raster);

  [[nodiscard]] std::span<const TexelSums> texels() const { return texels_; }

 private:
  using Triangles = std::vector<std::uint32_t>;

  void sort_into_bands();
  void prefetch(std::uint32_t triangle_idx) const;
  void integrate_triangles(const Triangles& triangles, const core::Observation& observation,
                           const ViewRaster& raster);

  const core::Mesh& mesh_;
  const core::Atlas& atlas_;
  int threads_;
  std::vector<TexelSums, HugePageAllocator<TexelSums>> texels_;
  std::vector<Triangles> bands_;        ///< by first row; from left to right
  Triangles high_;                      ///< triangles that reach over more rows
  std::array<float, 256> corrected_{};  ///< a channel's value without the view's gain
};

}  // namespace sheen::fitting::detail
