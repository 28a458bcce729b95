// SPDX-License-Identifier: MIT
#include "fitting/detail/texel_means.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/detail/four.h"

#include <algorithm>
#include <atomic>
#include <optional>

namespace sheen::fitting::detail {
namespace {

/// Triangles whose vertices are asked of the memory before they are needed.
constexpr std::size_t kAhead = 8;

/// CornerColours while they grow; a colour is 1, R, G, B.
struct CornerSums {
  std::array<Four, 3> colour{};
  Four square{}, product{};

  void add(const Four& one_rgb, const std::array<float, 3>& weight) {
    const Four w{weight[0], weight[1], weight[2], 0};
    const Four next{weight[1], weight[2], weight[0], 0};
    square += w * w;
    product += w * next;
    for (std::size_t corner = 0; corner < 3; ++corner) colour[corner] += weight[corner] * one_rgb;
  }

  [[nodiscard]] CornerColours sums() const {
    CornerColours corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      corners.weight[corner] = colour[corner][0];
      corners.square[corner] = square[corner];
      corners.product[corner] = product[corner];
      corners.colour[corner] = {colour[corner][1], colour[corner][2], colour[corner][3]};
    }
    return corners;
  }
};

/// Bilinear: 1, R, G, B. The image goes on for a pixel beyond the four around the place.
Four colour_at(const cv::Mat& bgr, const Eigen::Vector2f& at_px) {
  const auto x = static_cast<int>(at_px.x());
  const auto y = static_cast<int>(at_px.y());
  const float right = at_px.x() - static_cast<float>(x);
  const float below = at_px.y() - static_cast<float>(y);
  const std::uint8_t* const upper = bgr.ptr<std::uint8_t>(y) + 3 * x;
  const std::uint8_t* const lower = upper + bgr.step[0];
  const Four above = (1 - right) * four_bytes(upper) + right * four_bytes(upper + 3);
  const Four under = (1 - right) * four_bytes(lower) + right * four_bytes(lower + 3);
  const Four colour = (1 - below) * above + below * under;
  return Four{1, colour[2], colour[1], colour[0]};
}

Texel stored(const WeightedMean& mean) {
  const float per_weight = 0.25f / static_cast<float>(mean.weight);
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>(
        std::min(255.0f, static_cast<float>(mean.colour[c]) * per_weight + 0.5f));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

TexelMeans::TexelMeans(const core::Mesh& mesh, const core::Atlas& atlas, int threads)
    : mesh_(mesh),
      threads_(threads),
      surface_(atlas),
      means_(surface_.size()),
      corners_(mesh.triangles.size()) {}

// A texel belongs to one triangle: no two threads add to the same one.
void TexelMeans::integrate(const core::Observation& observation, const ViewRaster& raster,
                           SurfaceTexture& texture) {
  page_is_touched_.assign(texture.page_count(), 0);
  core::parallel_for(mesh_.triangles.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (t + kAhead < end) raster.prefetch(t + kAhead);
      integrate_triangle(static_cast<std::uint32_t>(t), observation, raster, texture);
    }
  });
}

void TexelMeans::integrate_triangle(std::uint32_t triangle_idx,
                                    const core::Observation& observation, const ViewRaster& raster,
                                    SurfaceTexture& texture) {
  corners_[triangle_idx] = {};
  const std::optional<SeenTriangle> triangle = raster.triangle(triangle_idx);
  if (!triangle) return;
  CornerSums corners;
  bool gaps = false;
  const auto without_gain = static_cast<float>(1 / observation.gain);
  const Four gain{1, without_gain, without_gain, without_gain};
  WeightedMean* next = means_.data() + surface_.before(triangle_idx);
  for (const SurfaceTexel& texel : surface_.of(triangle_idx)) {
    WeightedMean& mean = *next++;
    const std::array<float, 3> weight{1.0f - texel.at_second - texel.at_third, texel.at_second,
                                      texel.at_third};
    const auto at_px = raster.place(*triangle, weight);
    if (!at_px) {
      gaps = gaps || mean.weight == 0;
      continue;
    }
    Four colour = colour_at(observation.image, *at_px) * gain;
    colour = colour > 255.0f ? Four{255, 255, 255, 255} : colour;
    const float cosine = triangle->cosine(weight);
    mean.add(colour, cosine * cosine);
    corners.add(colour, weight);
    store(texel.texel_idx, stored(mean), texture);
  }
  corners_[triangle_idx] = corners.sums();
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
  const WeightedMean* mean = of(triangle_idx).data();
  for (const SurfaceTexel& texel : surface_.of(triangle_idx)) {
    if (mean++->weight == 0) store(texel.texel_idx, around, texture);
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
