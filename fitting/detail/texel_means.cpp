// SPDX-License-Identifier: MIT
#include "fitting/detail/texel_means.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/detail/four.h"

#include <algorithm>
#include <atomic>

namespace sheen::fitting::detail {
namespace {

/// Triangles whose vertices are asked of the memory before they are needed.
constexpr std::size_t kAhead = 8;

/// Pixels of three bytes: B, G, R.
struct Image {
  const std::uint8_t* pixels;
  std::size_t row;  ///< bytes from row to row
};

/// Bilinear: 1, R, G, B. The image goes on for a pixel beyond the four around the place.
SHEEN_INLINE Four colour_at(const Image& bgr, float x_px, float y_px) {
  const auto x = static_cast<int>(x_px);
  const auto y = static_cast<int>(y_px);
  const float right = x_px - static_cast<float>(x);
  const float below = y_px - static_cast<float>(y);
  const std::uint8_t* const upper = bgr.pixels + static_cast<std::size_t>(y) * bgr.row + 3 * x;
  const std::uint8_t* const lower = upper + bgr.row;
  const Four above = (1 - right) * four_bytes(upper) + right * four_bytes(upper + 3);
  const Four under = (1 - right) * four_bytes(lower) + right * four_bytes(lower + 3);
  const Four colour = (1 - below) * above + below * under;
  return Four{1, colour[2], colour[1], colour[0]};
}

/// Rounded.
SHEEN_INLINE Texel stored(const WeightedMean& mean) {
  const Four rgb = mean.any_rgb() + 0.5f;
  const FourInts bytes = as_ints(rgb > 255.0f ? Four{255, 255, 255, 255} : rgb);
  return {static_cast<std::uint8_t>(bytes[1]), static_cast<std::uint8_t>(bytes[2]),
          static_cast<std::uint8_t>(bytes[3])};
}

}  // namespace

TexelMeans::TexelMeans(const core::Mesh& mesh, const SurfaceTexture& texture, int threads)
    : mesh_(mesh),
      threads_(threads),
      surface_(texture.atlas()),
      means_(surface_.size()),
      corners_(mesh.triangles.size()),
      pages_before_{0},
      page_is_touched_(texture.page_count()) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const SurfaceTexel& texel : surface_.of(t)) {
      const auto page = static_cast<std::uint32_t>(texture.page_of(texel.texel_idx));
      const auto first = pages_.begin() + static_cast<std::ptrdiff_t>(pages_before_[t]);
      if (std::find(first, pages_.end(), page) == pages_.end()) pages_.push_back(page);
    }
    pages_before_.push_back(static_cast<std::uint32_t>(pages_.size()));
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void TexelMeans::integrate_triangles(std::size_t begin, std::size_t end,
                                     const core::Observation& observation, const ViewRaster& raster,
                                     SurfaceTexture& texture) {
  const auto without_gain = static_cast<float>(1 / observation.gain);
  const Four gain{1, without_gain, without_gain, without_gain};
  const Image image{observation.image.data, observation.image.step[0]};
  Texel* const shown = texture.texels().data();
  for (std::size_t t = begin; t < end; ++t) {
    if (t + kAhead < end) raster.prefetch(t + kAhead);
    if (!raster.is_front(t)) continue;
    const SeenTriangle triangle = raster.triangle(t);
    const std::span<const SurfaceTexel> texels = surface_.of(t);
    WeightedMean* const means = means_.data() + surface_.before(t);
    CornerColours corners;
    bool gaps = false;
    for (std::size_t first = 0; first < texels.size(); first += 4) {
      const FourWeights weight = weights_of_four(&texels[first]);
      const FourPlaces places = raster.places(triangle, weight);
      const unsigned all = bits_below(texels.size() - first);
      for_bits(places.seen & all, [&](std::size_t i) SHEEN_INLINE_LAMBDA {
        WeightedMean& mean = means[first + i];
        Four colour = colour_at(image, places.x_px[i], places.y_px[i]) * gain;
        colour = colour > 255.0f ? Four{255, 255, 255, 255} : colour;
        mean.add(colour, places.cosine[i] * places.cosine[i]);
        corners.add(colour, Four{weight[0][i], weight[1][i], weight[2][i], 0});
        shown[texels[first + i].texel_idx] = stored(mean);
      });
      for_bits(all & ~places.seen,
               [&](std::size_t i) { gaps = gaps || means[first + i].weight == 0; });
    }
    corners_[t] = corners;
    if (!corners.is_empty()) touch_pages(t);
    if (gaps) fill_gaps(t, texture);
  }
}

// A texel belongs to one triangle: no two threads add to the same one.
void TexelMeans::integrate(const core::Observation& observation, const ViewRaster& raster,
                           SurfaceTexture& texture) {
  std::ranges::fill(page_is_touched_, 0);
  core::parallel_for(mesh_.triangles.size(), threads_, [&](std::size_t begin, std::size_t end) {
    integrate_triangles(begin, end, observation, raster, texture);
  });
}

// Triangles of several threads may share a page.
void TexelMeans::touch_pages(std::size_t triangle_idx) {
  for (std::size_t i = pages_before_[triangle_idx]; i < pages_before_[triangle_idx + 1]; ++i) {
    std::atomic_ref(page_is_touched_[pages_[i]]).store(1, std::memory_order_relaxed);
  }
}

// What is not seen itself looks like the triangle around it.
void TexelMeans::fill_gaps(std::size_t triangle_idx, SurfaceTexture& texture) {
  const CornerColours& corners = corners_[triangle_idx];
  const Four sum = corners.colour[0] + corners.colour[1] + corners.colour[2];
  if (!(sum[0] > 0)) return;
  Texel around;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    around[channel] = static_cast<std::uint8_t>(sum[channel + 1] / sum[0] + 0.5f);
  }
  const WeightedMean* mean = of(triangle_idx).data();
  for (const SurfaceTexel& texel : surface_.of(triangle_idx)) {
    if (mean++->weight == 0) texture.texels()[texel.texel_idx] = around;
  }
}

std::vector<std::uint32_t> TexelMeans::touched_pages() const {
  std::vector<std::uint32_t> pages;
  for (std::uint32_t page = 0; page < page_is_touched_.size(); ++page) {
    if (page_is_touched_[page] != 0) pages.push_back(page);
  }
  return pages;
}

}  // namespace sheen::fitting::detail
