// SPDX-License-Identifier: MIT
#include "fitting/detail/vertex_means.h"

#include <cstddef>
#include <cstdlib>

namespace sheen::fitting::detail {
namespace {

/// Pixels that a vertex's surroundings must cover, weighted, for their mean to be taken.
constexpr float kFewestPixels = 1.0f;
/// Share of the surroundings that must be seen.
constexpr float kLeastSeen = 0.6f;

}  // namespace

VertexMeans::VertexMeans(const core::Mesh& mesh) : mesh_(mesh), offsets_(mesh.positions.size() + 1, 0) {
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

void VertexMeans::average(std::span<const TriangleColours> triangles,
                          core::SampleBatch& samples) {
  const int sweeps = std::getenv("FE") ? std::atoi(std::getenv("FE")) : 0;
  const std::size_t n = mesh_.positions.size();
  value_.assign(n, Eigen::Vector3f::Zero());
  static std::vector<float> lumped, expected; lumped.assign(n, 0.0f); expected.assign(n, 0.0f);
  const auto gather = [&](std::uint32_t v, bool first, const std::vector<Eigen::Vector3f>& d) {
    Eigen::Vector3f g = Eigen::Vector3f::Zero();
    float l = 0;
    for (std::uint32_t c = offsets_[v]; c < offsets_[v + 1]; ++c) {
      const TriangleColours& t = triangles[corners_[c].triangle_idx];
      if (t.texels == 0) continue;
      const std::uint32_t i = corners_[c].corner;
      const std::uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
      g += Eigen::Vector3f(t.colour[i].data());
      const float mij = t.matrix[3 + i], mik = t.matrix[3 + k];
      l += t.matrix[i] + mij + mik;
      if (!first) {
        const auto& tri = mesh_.triangles[corners_[c].triangle_idx];
        g -= t.matrix[i] * d[tri[i]] + mij * d[tri[j]] + mik * d[tri[k]];
      }
    }
    if (first) lumped[v] = l;
    return g;
  };
  for (std::uint32_t v = 0; v < n; ++v) { const Eigen::Vector3f g = gather(v, true, value_); if (lumped[v] > 0) value_[v] = g / lumped[v]; }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    next_ = value_;
    for (std::uint32_t v = 0; v < n; ++v) if (lumped[v] > 0.5f) next_[v] += gather(v, false, value_) / lumped[v];
    value_.swap(next_);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint32_t vertex = samples.patch[i];
    std::array<float, 3> rgb{samples.r[i], samples.g[i], samples.b[i]};
    float all = 0; (void)all;
    if (lumped[vertex] >= kFewestPixels) {
      for (std::size_t channel = 0; channel < 3; ++channel) rgb[channel] = value_[vertex][static_cast<Eigen::Index>(channel)] / 255.0f;
    } else if (subtract) {
      for (std::size_t channel = 0; channel < 3; ++channel) rgb[channel] += 0.5f - (*subtract)[vertex][static_cast<Eigen::Index>(channel)];
    }
    samples.patch[kept] = vertex;
    samples.u[kept] = samples.u[i];
    samples.v[kept] = samples.v[i];
    samples.r[kept] = rgb[0];
    samples.g[kept] = rgb[1];
    samples.b[kept] = rgb[2];
    ++kept;
  }
  samples.patch.resize(kept);
  for (auto* column : {&samples.u, &samples.v, &samples.r, &samples.g, &samples.b}) {
    column->resize(kept);
  }
}

}  // namespace sheen::fitting::detail
