// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
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
  std::array<float, 3> weight{};                 ///< sum of w, corner by corner
  std::array<float, 3> square{};                 ///< sum of w w
  std::array<float, 3> product{};                ///< sum of w times the next corner's w
  std::array<std::array<float, 3>, 3> colour{};  ///< sum of w times the colour, RGB, 0 to 255
};

/// The mean colour of every texel over all views so far.
class TexelMeans {
 public:
  /// `mesh` outlives it; `atlas` is one of its.
  TexelMeans(const core::Mesh& mesh, const core::Atlas& atlas, int threads);

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
  /// Of the last view, one for each triangle.
  [[nodiscard]] const std::vector<CornerColours>& corners() const { return corners_; }

 private:
  void integrate_triangle(std::uint32_t triangle_idx, const core::Observation& observation,
                          const ViewRaster& raster, SurfaceTexture& texture);
  void fill_gaps(std::uint32_t triangle_idx, SurfaceTexture& texture);
  void store(std::uint32_t texel_idx, const Texel& texel, SurfaceTexture& texture);

  const core::Mesh& mesh_;
  int threads_;
  SurfaceTexels surface_;
  std::vector<WeightedMean> means_;  ///< triangle by triangle: memory is walked in its order
  std::vector<CornerColours> corners_;
  std::vector<std::uint8_t> page_is_touched_;
};

}  // namespace sheen::fitting::detail
