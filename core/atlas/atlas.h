// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/chart.h"
#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::core {

/// Texels between a chart and the border of its rectangle: what a bilinear reading inside the chart
/// touches, and the same again for a reader that draws at half size.
inline constexpr int kGutterTexels = 2;
/// Largest side of an atlas, texels: what every OpenGL 4.5 driver holds.
inline constexpr int kMostAtlasSide = 16384;
/// Most texels that an atlas may have.
inline constexpr int kMostAtlasTexels = 1 << 26;

/// A place on an atlas: parts of 65535 of its width and height, from the upper left corner of its
/// first texel. As glTF's normalised unsigned shorts.
struct AtlasPoint {
  std::uint16_t u = 0, v = 0;
  bool operator==(const AtlasPoint&) const = default;
};

/// A texture's layout over a mesh: charts in rectangles side by side. Texel (i, j), column and row,
/// covers the square from (i, j) to (i + 1, j + 1); its centre lies at (i + 0.5, j + 0.5).
struct Atlas {
  struct Rectangle {
    Eigen::Vector2i origin, size;  ///< texels, gutter included
  };

  int width = 1, height = 1;                       ///< texels, >= 1
  std::vector<Rectangle> charts;                   ///< disjoint; unknown (none) of one from a file
  std::vector<std::array<AtlasPoint, 3>> corners;  ///< of every triangle of the mesh

  [[nodiscard]] std::size_t texel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  /// A corner's place, texels.
  [[nodiscard]] Eigen::Vector2f place(std::size_t triangle_idx, std::size_t corner) const {
    const AtlasPoint& point = corners[triangle_idx][corner];
    return {static_cast<float>(point.u) * static_cast<float>(width) / 65535.0f,
            static_cast<float>(point.v) * static_cast<float>(height) / 65535.0f};
  }
};

/// Lays charts out, each within a gutter. Together they hold each of `triangle_count` triangles
/// once.
Atlas pack_charts(std::span<const Chart> charts, std::size_t triangle_count);

/// Charts of a mesh, a texel for every texel_m squared (> 0) of its surface;
/// larger texels where the atlas would have more than `most_texels` or not fit kMostAtlasSide.
Atlas make_atlas(const Mesh& mesh, float texel_m, std::size_t most_texels);

}  // namespace sheen::core
