// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "fitting/detail/four.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/detail/view_raster.h"
#include "fitting/detail/weighted_mean.h"
#include "fitting/texture/surface_texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// What one view shows of a triangle: the normal equations of three colours at its corners that are
/// interpolated in between. Sums over its texels of the corners' barycentric weights w there.
struct CornerColours {
  std::array<Four, 3> colour{};  ///< corner by corner, sum of w times (1, R, G, B), 0 to 255
  Four square{};                 ///< sum of w w, corner by corner, and 0
  Four product{};                ///< sum of w times the next corner's w

  SHEEN_INLINE void add(const Four& one_rgb, const Four& w) {
    square += w * w;
    product += w * __builtin_shufflevector(w, w, 1, 2, 0, 3);
    for (std::size_t corner = 0; corner < 3; ++corner) colour[corner] += w[corner] * one_rgb;
  }

  [[nodiscard]] bool is_empty() const {
    return !(colour[0][0] + colour[1][0] + colour[2][0] > 0.0f);
  }
};

/// The mean colour of every texel over all views so far.
class TexelMeans {
 public:
  /// `mesh` outlives it; `texture` is one of its.
  TexelMeans(const core::Mesh& mesh, const SurfaceTexture& texture, int threads);

  /// Adds a view, and writes the means of what it shows into `texture`. The same on any number of
  /// threads.
  void integrate(const core::Observation& observation, const ViewRaster& raster,
                 SurfaceTexture& texture);

  /// Pages of the texture that the last view changed, ascending.
  [[nodiscard]] std::vector<std::uint32_t> touched_pages() const;

  [[nodiscard]] const SurfaceTexels& surface() const { return surface_; }
  /// Those of a triangle's texels, in the order of surface().of(triangle_idx).
  [[nodiscard]] std::span<const WeightedMean> of(std::size_t triangle_idx) const {
    return {means_.data() + surface_.before(triangle_idx), surface_.of(triangle_idx).size()};
  }
  /// Of the last view, one for each triangle; only those of its fronts are up to date.
  [[nodiscard]] const std::vector<CornerColours>& corners() const { return corners_; }

 private:
  void integrate_triangles(std::size_t begin, std::size_t end, const core::Observation& observation,
                           const ViewRaster& raster, SurfaceTexture& texture);
  void fill_gaps(std::size_t triangle_idx, SurfaceTexture& texture);
  void touch_pages(std::size_t triangle_idx);

  const core::Mesh& mesh_;
  int threads_;
  SurfaceTexels surface_;
  std::vector<WeightedMean> means_;  ///< triangle by triangle: memory is walked in its order
  std::vector<CornerColours> corners_;
  std::vector<std::uint32_t> pages_before_, pages_;  ///< those that hold a triangle's texels
  std::vector<std::uint8_t> page_is_touched_;
};

}  // namespace sheen::fitting::detail
