// SPDX-License-Identifier: MIT
#include "fitting/detail/texel_means.h"

#include "core/concurrency/parallel_for.h"
#include "core/image/bilinear.h"

#include <algorithm>
#include <atomic>
#include <optional>

namespace sheen::fitting::detail {
namespace {

using Rgb = std::array<float, 3>;

void add(const Rgb& rgb, const std::array<float, 3>& weight, CornerColours& corners) {
  for (std::size_t corner = 0; corner < 3; ++corner) {
    corners.weight[corner] += weight[corner];
    corners.square[corner] += weight[corner] * weight[corner];
    corners.product[corner] += weight[corner] * weight[(corner + 1) % 3];
    for (std::size_t channel = 0; channel < 3; ++channel) {
      corners.colour[corner][channel] += weight[corner] * rgb[channel];
    }
  }
}

Texel stored(const WeightedMean& mean) {
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>((mean.colour[c] + 2 * mean.weight) / (4 * mean.weight));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

TexelMeans::TexelMeans(const core::Mesh& mesh, const core::Atlas& atlas, int threads)
    : mesh_(mesh),
      threads_(threads),
      surface_(atlas),
      means_(atlas.texel_count()),
      corners_(mesh.triangles.size()) {}

// A texel belongs to one triangle: no two threads add to the same one.
void TexelMeans::integrate(const core::Observation& observation, const ViewRaster& raster,
                           SurfaceTexture& texture) {
  page_is_touched_.assign(texture.page_count(), 0);
  core::parallel_for(mesh_.triangles.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      integrate_triangle(static_cast<std::uint32_t>(t), observation, raster, texture);
    }
  });
}

void TexelMeans::integrate_triangle(std::uint32_t triangle_idx,
                                    const core::Observation& observation, const ViewRaster& raster,
                                    SurfaceTexture& texture) {
  CornerColours& corners = corners_[triangle_idx];
  corners = {};
  const std::optional<SeenTriangle> triangle = raster.triangle(triangle_idx);
  if (!triangle) return;
  bool gaps = false;
  const auto without_gain = static_cast<float>(1 / observation.gain);
  for (const SurfaceTexel& texel : surface_.of(triangle_idx)) {
    const std::array<float, 3> weight{1.0f - texel.at_second - texel.at_third, texel.at_second,
                                      texel.at_third};
    const auto at_px = raster.place(*triangle, weight);
    if (!at_px) {
      gaps = gaps || means_[texel.texel_idx].weight == 0;
      continue;
    }
    Rgb rgb = core::bilinear_rgb(observation.image, *at_px);
    for (float& channel : rgb) channel = std::min(255.0f, channel * without_gain);
    WeightedMean& mean = means_[texel.texel_idx];
    const float cosine = triangle->cosine(weight);
    mean.add(rgb, cosine * cosine);
    add(rgb, weight, corners);
    store(texel.texel_idx, stored(mean), texture);
  }
  if (gaps) fill_gaps(triangle_idx, texture);
}

// What is not seen itself looks like the triangle around it.
void TexelMeans::fill_gaps(std::uint32_t triangle_idx, SurfaceTexture& texture) {
  const CornerColours& corners = corners_[triangle_idx];
  const float weight = corners.weight[0] + corners.weight[1] + corners.weight[2];
  if (!(weight > 0)) return;
  Texel around;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    around[channel] = static_cast<std::uint8_t>(
        (corners.colour[0][channel] + corners.colour[1][channel] + corners.colour[2][channel]) /
            weight +
        0.5f);
  }
  for (const SurfaceTexel& texel : surface_.of(triangle_idx)) {
    if (means_[texel.texel_idx].weight == 0) store(texel.texel_idx, around, texture);
  }
}

// Triangles of several threads may share a page.
void TexelMeans::store(std::uint32_t texel_idx, const Texel& texel, SurfaceTexture& texture) {
  texture.texels()[texel_idx] = texel;
  std::atomic_ref(page_is_touched_[texture.page_of(texel_idx)]).store(1, std::memory_order_relaxed);
}

std::vector<std::uint32_t> TexelMeans::touched_pages() const {
  std::vector<std::uint32_t> pages;
  for (std::uint32_t page = 0; page < page_is_touched_.size(); ++page) {
    if (page_is_touched_[page] != 0) pages.push_back(page);
  }
  return pages;
}

}  // namespace sheen::fitting::detail
