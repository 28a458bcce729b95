// SPDX-License-Identifier: MIT
#include "fitting/detail/vertex_means.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <limits>

namespace sheen::fitting::detail {
namespace {

/// Weight that the texels around a vertex must have together for their mean to be taken.
constexpr float kLeastWeight = 1.0f;
constexpr int kMeanSteps = 3;

}  // namespace

VertexMeans::VertexMeans(const core::Mesh& mesh, int threads)
    : mesh_(mesh),
      threads_(threads),
      offsets_(mesh.positions.size() + 1, 0),
      weight_(mesh.positions.size()),
      colour_(mesh.positions.size()),
      next_(mesh.positions.size()) {
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) ++offsets_[vertex + 1];
  }
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  corners_.resize(offsets_.back());
  std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      corners_[next[mesh.triangles[t][corner]]++] = {t, corner};
    }
  }
}

template <typename Body>
void VertexMeans::for_vertices(const Body& body) const {
  core::parallel_for(weight_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t vertex = begin; vertex < end; ++vertex) body(vertex);
  });
}

// Weighted means first, which are too smooth, then steps of Jacobi's method with the weights (the
// sums of the matrix' rows) in place of its diagonal.
void VertexMeans::average(const ViewRaster& raster, std::span<const CornerColours> triangles,
                          core::SampleBatch& samples) {
  for_vertices([&](std::size_t vertex) {
    Four sum{};
    for (const Corner& at : corners_at(vertex)) {
      if (raster.is_front(at.triangle_idx)) sum += triangles[at.triangle_idx].colour[at.corner];
    }
    weight_[vertex] = sum[0];
    colour_[vertex] = sum / std::max(sum[0], std::numeric_limits<float>::min());
  });
  for (int step = 0; step < kMeanSteps; ++step) {
    for_vertices([&](std::size_t vertex) {
      next_[vertex] = colour_[vertex];
      if (weight_[vertex] < kLeastWeight) return;
      Four left{};
      for (const Corner& at : corners_at(vertex)) {
        if (!raster.is_front(at.triangle_idx)) continue;
        const CornerColours& triangle = triangles[at.triangle_idx];
        const auto& corners = mesh_.triangles[at.triangle_idx];
        const std::uint32_t after = (at.corner + 1) % 3;
        const std::uint32_t before = (at.corner + 2) % 3;
        left += triangle.colour[at.corner] - triangle.square[at.corner] * colour_[vertex] -
                triangle.product[at.corner] * colour_[corners[after]] -
                triangle.product[before] * colour_[corners[before]];
      }
      next_[vertex] += left / weight_[vertex];
    });
    colour_.swap(next_);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint32_t vertex = samples.patch[i];
    if (weight_[vertex] < kLeastWeight) continue;
    const Four rgb = colour_[vertex] / 255.0f;
    samples.r[i] = rgb[1];
    samples.g[i] = rgb[2];
    samples.b[i] = rgb[3];
  }
}

}  // namespace sheen::fitting::detail
