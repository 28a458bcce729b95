// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/detail/view_raster.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// The atlas' texels that hold some of the surface, ascending: what bases have numbers for.
std::vector<std::uint32_t> used_texels(const core::Atlas& atlas,
                                       const detail::SurfaceTexels& surface,
                                       std::size_t triangle_count);

/// A texel that a view shows.
struct SeenTexel {
  std::uint32_t slot;               ///< index among the used texels
  std::array<std::uint8_t, 3> rgb;  ///< without the view's gain
  std::uint8_t weight;              ///< squared cosine between normal and view, 255ths, > 0

  [[nodiscard]] float squared_cosine() const { return static_cast<float>(weight) / 255.0f; }
};

/// Resamples views into the texture's space: the mask is which texels are listed.
class TexelReader {
 public:
  /// Mesh and atlas, one of its, outlive it.
  TexelReader(const core::Mesh& mesh, const core::Atlas& atlas, int threads);

  /// What a view shows, by slot. The same on any number of threads.
  std::vector<SeenTexel> read(const core::Observation& observation);

  [[nodiscard]] const std::vector<std::uint32_t>& used() const { return used_; }
  [[nodiscard]] const detail::SurfaceTexels& surface() const { return surface_; }

 private:
  void read_triangle(std::uint32_t triangle_idx, const core::Observation& observation);

  const core::Mesh& mesh_;
  int threads_;
  detail::SurfaceTexels surface_;
  detail::ViewRaster raster_;
  std::vector<std::uint32_t> used_;
  std::vector<SeenTexel> by_texel_;  ///< of the whole atlas, in the last view; weight 0: unseen
};

}  // namespace sheen::fitting::eigen_texture
