// SPDX-License-Identifier: MIT
#include "fitting/detail/texel_means.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::detail {
namespace {

constexpr float kLeastCosine = 0.2f;  // as SamplingLimits
constexpr float kWeightUnits = 64.0f;
constexpr float kColourUnits = 4.0f;  // of a step of the image
/// A texel takes no more when its sums could overflow: after 65,000 views that see it frontally.
constexpr std::uint32_t kFull = 0xffffffffU / 1020U - 64U;

/// Bilinear, 0 to 255, RGB; the four pixels exist.
std::array<float, 3> read(const cv::Mat& image, float x_px, float y_px) {
  const auto x = static_cast<int>(x_px);
  const auto y = static_cast<int>(y_px);
  const float right = x_px - static_cast<float>(x);
  const float below = y_px - static_cast<float>(y);
  const std::uint8_t* upper = image.ptr<std::uint8_t>(y) + 3 * x;
  const std::uint8_t* lower = upper + image.step[0];
  const float w0 = (1 - right) * (1 - below), w1 = right * (1 - below), w2 = (1 - right) * below,
              w3 = right * below;
  const auto channel = [&](int c) {
    return w0 * static_cast<float>(upper[c]) + w1 * static_cast<float>(upper[c + 3]) +
           w2 * static_cast<float>(lower[c]) + w3 * static_cast<float>(lower[c + 3]);
  };
  return {channel(2), channel(1), channel(0)};
}

}  // namespace

TexelMeans::TexelMeans(const core::Mesh& mesh, const core::Atlas& atlas, int threads)
    : mesh_(mesh),
      threads_(threads),
      surface_(atlas),
      means_(atlas.texel_count()),
      triangles_(mesh.triangles.size()) {}

void TexelMeans::integrate(const core::Observation& observation, const ViewRaster& raster) {
  const auto without_gain = static_cast<float>(1 / observation.gain);
  core::parallel_for(mesh_.triangles.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      TriangleColours& seen = triangles_[t];
      seen = {};
      if (!(raster.area_px2(t) > 0.0f)) continue;
      const auto& triangle = mesh_.triangles[t];
      const ViewRaster::Vertex& a = raster.vertex(triangle[0]);
      const ViewRaster::Vertex& b = raster.vertex(triangle[1]);
      const ViewRaster::Vertex& c = raster.vertex(triangle[2]);
      if (std::max({a.cosine, b.cosine, c.cosine}) < kLeastCosine) continue;
      const float depth_a = 1 / a.inverse_depth, depth_b = 1 / b.inverse_depth,
                  depth_c = 1 / c.inverse_depth;
      for (const SurfaceTexel& texel : surface_.of(t)) {
        const float wb = texel.at_second;
        const float wc = texel.at_third;
        const float wa = 1.0f - wb - wc;
        const float cosine = wa * a.cosine + wb * b.cosine + wc * c.cosine;
        if (!(cosine >= kLeastCosine)) continue;
        const float za = wa * depth_a, zb = wb * depth_b, zc = wc * depth_c;
        const float inverse_depth = 1.0f / (za + zb + zc);
        const float x_px = (za * a.x_px + zb * b.x_px + zc * c.x_px) * inverse_depth;
        const float y_px = (za * a.y_px + zb * b.y_px + zc * c.y_px) * inverse_depth;
        if (!raster.shows(x_px, y_px, inverse_depth, cosine)) continue;
        std::array<float, 3> rgb = read(observation.image, x_px, y_px);
        TexelMean& mean = means_[texel.texel_idx];
        const auto q = static_cast<std::uint32_t>(cosine * cosine * kWeightUnits + 0.5f);
        const bool full = subtract || mean.weight > kFull;
        const std::array<float, 3> w{wa, wb, wc};
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const float value = std::min(255.0f, rgb[channel] * without_gain);
          if (!full) {
            mean.colour[channel] += q * static_cast<std::uint32_t>(value * kColourUnits + 0.5f);
          }
          const float left = subtract ? value - (*subtract)[channel][texel.texel_idx] + 127.5f : value;
          for (std::size_t i = 0; i < 3; ++i) seen.colour[i][channel] += w[i] * left;
        }
        if (!full) mean.weight += q;
        seen.texels += 1;
        for (std::size_t i = 0; i < 3; ++i) {
          seen.matrix[i] += w[i] * w[i];
          seen.matrix[3 + i] += w[i] * w[(i + 1) % 3];
        }
      }
    }
  });
}

}  // namespace sheen::fitting::detail
