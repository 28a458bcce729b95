// SPDX-License-Identifier: MIT
#include "fitting/detail/texture_sums.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::detail {
namespace {

/// Triangles of a band touch texels in this many rows from its first one on, and in as many more.
constexpr int kBandRows = 64;

struct Rows {
  int first, last;
};

/// Rows that readings within a triangle touch.
Rows rows_of(const core::Atlas& atlas, std::size_t triangle_idx) {
  const float a = atlas.place(triangle_idx, 0).y();
  const float b = atlas.place(triangle_idx, 1).y();
  const float c = atlas.place(triangle_idx, 2).y();
  const auto first = static_cast<int>(std::floor(std::min({a, b, c}) - 0.5f));
  const auto last = static_cast<int>(std::floor(std::max({a, b, c}) - 0.5f)) + 1;
  // Places are rounded to an eighth of a texel.
  return {std::max(first, 0), std::min(last + 1, atlas.height - 1)};
}

}  // namespace

TextureSums::TextureSums(const core::Mesh& mesh, const core::Atlas& atlas, int threads)
    : mesh_(mesh),
      atlas_(atlas),
      threads_(threads),
      texels_(atlas.texel_count()),
      bands_(static_cast<std::size_t>((atlas.height + kBandRows - 1) / kBandRows)) {
  sort_into_bands();
}

void TextureSums::sort_into_bands() {
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Rows rows = rows_of(atlas_, t);
    const int band = rows.first / kBandRows;
    const bool fits = rows.last < (band + 2) * kBandRows;
    (fits ? bands_[static_cast<std::size_t>(band)] : high_).push_back(t);
  }
  // Neighbours on the atlas one after the other find their texels in the cache.
  const auto block = [&](std::uint32_t t) {
    return static_cast<int>(atlas_.place(t, 0).x()) / kBandRows;
  };
  for (Triangles& band : bands_) {
    std::ranges::stable_sort(band, {}, block);
  }
}

// Without this a third of the time is spent waiting for the memory.
void TextureSums::prefetch(std::uint32_t triangle_idx) const {
  const Eigen::Vector2f a = atlas_.place(triangle_idx, 0);
  const Eigen::Vector2f b = atlas_.place(triangle_idx, 1);
  const Eigen::Vector2f c = atlas_.place(triangle_idx, 2);
  constexpr std::size_t most_rows = 8;
  const auto first =
      static_cast<std::size_t>(std::max(0.0f, std::min({a.y(), b.y(), c.y()}) - 0.5f));
  const auto last = static_cast<std::size_t>(std::max({a.y(), b.y(), c.y()}) + 0.5f);
  const auto left =
      static_cast<std::size_t>(std::max(0.0f, std::min({a.x(), b.x(), c.x()}) - 0.5f));
  const auto right = static_cast<std::size_t>(std::max({a.x(), b.x(), c.x()}) + 0.5f);
  for (std::size_t y = first; y <= std::min(last, first + most_rows); ++y) {
    const TexelSums* const row = texels_.data() + y * static_cast<std::size_t>(atlas_.width);
    for (std::size_t x = left; x <= right; x += 2) __builtin_prefetch(row + x, 1);
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void TextureSums::integrate_triangles(const Triangles& triangles,
                                      const core::Observation& observation,
                                      const ViewRaster& raster) {
  constexpr std::size_t ahead = 6;  // triangles
  const TexelGrid grid{texels_.data(), static_cast<std::size_t>(atlas_.width)};
  const std::uint8_t* const image = observation.image.data;
  const std::size_t row = observation.image.step[0];
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i + ahead < triangles.size() && raster.is_front(triangles[i + ahead])) {
      raster.prefetch(triangles[i + ahead]);
      prefetch(triangles[i + ahead]);
    }
    const std::uint32_t t = triangles[i];
    if (!raster.is_front(t)) continue;
    const Eigen::Vector2f a = atlas_.place(t, 0);
    const Eigen::Vector2f b = atlas_.place(t, 1);
    const Eigen::Vector2f c = atlas_.place(t, 2);
    raster.for_pixels(raster.triangle(t), [&](const FourPixels& pixels) SHEEN_INLINE_LAMBDA {
      const auto& [at_a, at_b, at_c] = pixels.weight;
      const FourReadings readings =
          readings_at(at_a * a.x() + at_b * b.x() + at_c * c.x(),
                      at_a * a.y() + at_b * b.y() + at_c * c.y(), pixels.cosine);
      const std::uint8_t* const bgr = image + static_cast<std::size_t>(pixels.y_px) * row +
                                      3 * static_cast<std::size_t>(pixels.x_px);
      for_bits(pixels.shown, [&](std::size_t k) SHEEN_INLINE_LAMBDA {
        add_pixel(grid, readings, k,
                  Four{1, corrected_[bgr[3 * k + 2]], corrected_[bgr[3 * k + 1]],
                       corrected_[bgr[3 * k]]});
      });
    });
  }
}

// Bands of equal parity share no row, so each may be worked on by another thread.
void TextureSums::integrate(const core::Observation& observation, const ViewRaster& raster) {
  for (std::size_t value = 0; value < corrected_.size(); ++value) {
    corrected_[value] = static_cast<float>(
        std::clamp(std::lround(static_cast<double>(value) / observation.gain), 0L, 255L));
  }
  for (const std::size_t parity : {std::size_t{0}, std::size_t{1}}) {
    core::parallel_for((bands_.size() + 1 - parity) / 2, threads_,
                       [&](std::size_t begin, std::size_t end) {
                         for (std::size_t i = begin; i < end; ++i) {
                           integrate_triangles(bands_[2 * i + parity], observation, raster);
                         }
                       },
                       1);
  }
  integrate_triangles(high_, observation, raster);
}

}  // namespace sheen::fitting::detail
