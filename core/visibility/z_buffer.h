// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/vertex_view.h"
#include "core/visibility/raster_kernels.h"
#include "core/visibility/triangle_clusters.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// Rectangle of pixels of the image, both ends included.
struct PixelBox {
  int left = 0, top = 0, right = -1, bottom = -1;
};

/// Draws the inverse depth (1 / depth) of a mesh's nearest fronts. Keeps its storage from view to
/// view.
class ZBuffer {
 public:
  ZBuffer(const Mesh& mesh, int threads, const RasterKernels& kernels);

  /// Draws the part of the image that `box` holds, of a view from `eye` (object frame, metres).
  /// False where too many triangles are large to be listed: all are drawn, with straight edges.
  bool draw(const VertexView& view, const Eigen::Vector3f& eye, const PixelBox& box);

  /// Drawn triangles wider or higher than kLarge_px, and all with a corner that has no pixel.
  [[nodiscard]] const std::vector<LargeTriangle>& large_triangles() const { return large_; }

  /// Inverse depth at a pixel of the image within the box, 1/m; 0 where nothing is.
  [[nodiscard]] float at(int x_px, int y_px) const { return *from(x_px, y_px); }
  /// The same, followed by those to the right of it.
  [[nodiscard]] const float* from(int x_px, int y_px) const {
    const auto x = static_cast<std::size_t>(x_px - static_cast<int>(left_px_));
    const auto y = static_cast<std::size_t>(y_px - static_cast<int>(top_px_));
    return maps_.front().data()->inverse_depth + y * row() + x;
  }

  /// Least and greatest inverse depth of the four pixels around a position within the box.
  struct Range {
    float least, greatest;
  };
  [[nodiscard]] Range around(float x_px, float y_px) const {
    const float x = x_px - left_px_;
    const float y = y_px - top_px_;
    const float* upper = maps_.front().data()->inverse_depth + static_cast<std::size_t>(y) * row() +
                         static_cast<std::size_t>(x);
    const float* lower = upper + row();
    const auto [upper_least, upper_greatest] = std::minmax(upper[0], upper[1]);
    const auto [lower_least, lower_greatest] = std::minmax(lower[0], lower[1]);
    return {std::min(upper_least, lower_least), std::max(upper_greatest, lower_greatest)};
  }

 private:
  struct alignas(sizeof(float) * DepthMap::kGroup) PixelGroup {
    float inverse_depth[DepthMap::kGroup] = {};
  };
  using Map = std::vector<PixelGroup>;

  static constexpr float kLarge_px = 24.0f;
  static constexpr std::size_t kMostLarge = 256;

  [[nodiscard]] std::size_t row() const { return groups_ * DepthMap::kGroup; }
  void clear(Map& map) const;
  void pack(const VertexView& view);
  void draw_clusters(std::size_t begin, std::size_t end, const Eigen::Vector3f& eye, Map& map,
                     LargeTriangles& large) const;
  void merge(std::size_t maps);

  TriangleClusters clusters_;
  int threads_;
  RasterKernels kernels_;
  std::vector<RasterVertex> vertices_;
  std::vector<Map> maps_;  ///< one per thread, merged into the first
  std::vector<LargeTriangle> large_;
  float left_px_ = 0, top_px_ = 0;
  std::int32_t width_px_ = 0, height_px_ = 0;
  std::size_t groups_ = 0;  ///< of a row
};

}  // namespace sheen::core
