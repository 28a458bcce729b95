// SPDX-License-Identifier: MIT
#include "fitting/detail/vertex_means.h"

#include <array>
#include <cstddef>

namespace sheen::fitting::detail {
namespace {

/// Weight that the texels around a vertex must have together for their mean to be taken.
constexpr float kLeastWeight = 1.0f;

}  // namespace

VertexMeans::VertexMeans(const core::Mesh& mesh) : offsets_(mesh.positions.size() + 1, 0) {
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

void VertexMeans::average(std::span<const CornerColours> triangles,
                          core::SampleBatch& samples) const {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint32_t vertex = samples.patch[i];
    float weight = 0;
    std::array<float, 3> sum{};
    for (std::uint32_t c = offsets_[vertex]; c < offsets_[vertex + 1]; ++c) {
      const CornerColours& triangle = triangles[corners_[c].triangle_idx];
      weight += triangle.weight[corners_[c].corner];
      for (std::size_t channel = 0; channel < 3; ++channel) {
        sum[channel] += triangle.colour[corners_[c].corner][channel];
      }
    }
    if (weight < kLeastWeight) continue;
    samples.r[i] = sum[0] / (255.0f * weight);
    samples.g[i] = sum[1] / (255.0f * weight);
    samples.b[i] = sum[2] / (255.0f * weight);
  }
}

}  // namespace sheen::fitting::detail
