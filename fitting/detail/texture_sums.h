// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "fitting/detail/texel_sums.h"
#include "fitting/detail/view_raster.h"
#include "fitting/texture/surface_texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace sheen::fitting::detail {

/// The sums of all texels of an atlas over all views so far.
class TextureSums {
 public:
  /// Texels are worked on and sent to a renderer in square pages of this side.
  static constexpr int kPage = 64;

  /// `mesh` outlives it; `atlas` is one of its.
  TextureSums(const core::Mesh& mesh, const core::Atlas& atlas, int threads);

  /// Adds the pixels of a view. The same on any number of threads.
  void integrate(const core::Observation& observation, const ViewRaster& raster);

  [[nodiscard]] const std::vector<TexelSums>& texels() const { return texels_; }
  std::function<Eigen::Vector3f(std::uint32_t t, const std::array<float, 3>&, const Eigen::Vector3f&)> pixel_offset; Eigen::Vector3f eye;
  std::vector<Eigen::Vector3f> offset;  // LAB: per vertex, of the view, 0..255


  [[nodiscard]] std::size_t page_count() const { return page_is_touched_.size(); }
  /// Pages in which the last view changed something, ascending.
  [[nodiscard]] std::vector<std::uint32_t> touched_pages() const;

 private:
  /// Triangles whose texels lie in rows [k, k + 2) * kPage for one k.
  struct Band {
    std::vector<std::uint32_t> triangles;
  };

  void sort_into_bands();
  void integrate_triangle(std::uint32_t triangle_idx, const core::Observation& observation, const ViewRaster& raster);
  void touch_pages(std::uint32_t triangle_idx);

  const core::Mesh& mesh_;
  const core::Atlas& atlas_;
  int threads_;
  std::vector<TexelSums> texels_;
  std::vector<Band> bands_;               ///< by first row
  std::vector<std::uint32_t> high_;       ///< triangles that reach over more rows
  std::array<std::uint8_t, 256> corrected_{};  ///< a channel's value without the view's gain
  std::size_t pages_per_row_;
  std::vector<std::uint8_t> page_is_touched_;
};

}  // namespace sheen::fitting::detail
