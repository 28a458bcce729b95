// SPDX-License-Identifier: MIT
#include "core/atlas/atlas.h"

#include "core/atlas/packing.h"
#include "core/atlas/triangle_shapes.h"
#include "core/mesh/bounds.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sheen::core {
namespace {

AtlasPoint point_at(const Eigen::Vector2f& place, int width, int height) {
  const auto part = [](float x, int size) {
    return static_cast<std::uint16_t>(
        std::clamp(std::lround(x / static_cast<float>(size) * 65535.0f), 0L, 65535L));
  };
  return {part(place.x(), width), part(place.y(), height)};
}

}  // namespace

Atlas pack_charts(std::span<const Chart> charts, std::size_t triangle_count) {
  // Rectangles of whole texels.
  std::vector<Eigen::Vector2i> sizes;
  sizes.reserve(charts.size());
  for (const Chart& chart : charts) {
    const Eigen::Vector2i texels = chart.size.array().ceil().cast<int>().cwiseMax(1);
    sizes.emplace_back(texels.array() + 2 * kGutterTexels);
  }
  const Packing packing = pack_rectangles(sizes);

  // Corners where their charts now lie.
  Atlas atlas;
  atlas.width = std::max(1, packing.size.x());
  atlas.height = std::max(1, packing.size.y());
  atlas.corners.resize(triangle_count);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    atlas.charts.push_back({packing.origins[c], sizes[c]});
    const Eigen::Vector2f origin = (packing.origins[c].array() + kGutterTexels).cast<float>();
    for (std::size_t i = 0; i < charts[c].triangles.size(); ++i) {
      const std::uint32_t triangle = charts[c].triangles[i];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        atlas.corners[triangle][corner] =
            point_at(charts[c].corners[i][corner] + origin, atlas.width, atlas.height);
      }
    }
  }
  return atlas;
}

Atlas make_atlas(const Mesh& mesh, float texel_m, std::size_t most_texels) {
  assert(texel_m > 0 && most_texels > 0);
  // The surface alone must not be too much.
  double surface_m2 = 0;
  for (const float area_m2 : triangle_shapes(mesh).area_m2) {
    surface_m2 += static_cast<double>(area_m2);
  }
  texel_m = std::max(texel_m,
                     static_cast<float>(std::sqrt(surface_m2 / static_cast<double>(most_texels))));
  // Nor the box of a chart, which follows a thin ring or frame round its hole.
  constexpr int most_chart_side = kMostAtlasSide / 4;
  texel_m = std::max(texel_m, bounds_of(mesh).diagonal().norm() / most_chart_side);
  // Area and gutters do not grow alike, so a second and a third step may be needed.
  constexpr int most_steps = 12;
  for (int step = 0;; ++step) {
    const std::vector<Chart> charts = make_charts(mesh, texel_m);
    Atlas atlas = pack_charts(charts, mesh.triangles.size());
    const double excess = std::max(
        static_cast<double>(atlas.texel_count()) / static_cast<double>(most_texels),
        std::pow(static_cast<double>(std::max(atlas.width, atlas.height)) / kMostAtlasSide, 2));
    if (excess <= 1 || step == most_steps) return atlas;
    texel_m *= static_cast<float>(std::sqrt(excess) * 1.02);
  }
}

}  // namespace sheen::core
