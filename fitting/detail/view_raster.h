// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "core/visibility/z_buffer.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::detail {

/// A pixel whose centre shows a triangle.
struct SurfacePixel {
  int x_px, y_px;
  std::array<float, 3> weight;  ///< of the triangle's corners on the surface, sum 1
  float cosine;                 ///< between normal and view, interpolated, > 0
};

/// Which pixels of a view show which triangle. Pixels are left out that another triangle hides,
/// that lie at a jump of depth (they mix two surfaces), near the border of the image, or that see
/// the surface at a grazing angle. Keeps its storage from view to view.
class ViewRaster {
 public:
  /// A vertex in the view.
  struct alignas(16) Vertex {
    float x_px, y_px, inverse_depth, cosine;  ///< inverse depth 0 where it has no pixel
  };

  /// `mesh` outlives it.
  ViewRaster(const core::Mesh& mesh, int threads);

  /// Looks at another view of the mesh.
  void set_view(const core::Observation& observation);

  /// Area of a triangle on the image, square pixels, whether or not something hides it; 0 where it
  /// is turned away or has a corner without a pixel.
  [[nodiscard]] float area_px2(std::size_t triangle_idx) const;

  [[nodiscard]] const Vertex& vertex(std::size_t vertex_idx) const { return vertices_[vertex_idx]; }

  /// Whether the four pixels around a place show one surface, at this depth or farther.
  [[nodiscard]] bool shows(float x_px, float y_px, float inverse_depth, float cosine) const {
    // Comparisons are written so that a number that is not one fails.
    if (!(x_px >= static_cast<float>(box_.left) && x_px < static_cast<float>(box_.right) &&
          y_px >= static_cast<float>(box_.top) && y_px < static_cast<float>(box_.bottom))) {
      return false;
    }
    const auto x = static_cast<int>(x_px);
    const auto y = static_cast<int>(y_px);
    const std::uint8_t* upper = whole_.data() + static_cast<std::size_t>(y - box_.top) * row_ +
                                static_cast<std::size_t>(x - box_.left);
    if ((upper[0] & upper[1] & upper[row_] & upper[row_ + 1]) == 0) return false;
    // Within a pixel the surface rises by tan = sqrt(1 - c^2) / c steps.
    const float rise = 1.0f + 2.0f * std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
    return depth_.at(x, y) <= inverse_depth * (1.0f + rise * step_);
  }

  /// Calls `visit(pixel)` for every pixel that shows the triangle, row by row. May be called from
  /// several threads at once.
  template <typename Visit>
  void for_each_pixel(std::size_t triangle_idx, const Visit& visit) const;

 private:
  void project(const core::Observation& observation);
  [[nodiscard]] core::PixelBox box_of(const core::Observation& observation) const;
  void find_whole_pixels();

  const core::Mesh& mesh_;
  int threads_;
  core::ZBuffer depth_;
  std::vector<Vertex> vertices_;
  core::PixelBox box_;           ///< pixels that may be visited
  float step_ = 0;               ///< angle of a pixel: change of depth per pixel at 45 degrees
  std::size_t row_ = 0;          ///< pixels in a row of the box
  std::vector<std::uint8_t> whole_;  ///< 1 where the four pixels around show the same surface
};

template <typename Visit>
void ViewRaster::for_each_pixel(std::size_t triangle_idx, const Visit& visit) const {
  constexpr float least_cosine = 0.2f;  // as SamplingLimits
  const auto& triangle = mesh_.triangles[triangle_idx];
  const Vertex& a = vertices_[triangle[0]];
  const Vertex& b = vertices_[triangle[1]];
  const Vertex& c = vertices_[triangle[2]];
  const float area = (c.x_px - a.x_px) * (b.y_px - a.y_px) - (b.x_px - a.x_px) * (c.y_px - a.y_px);
  if (!(area > 0.0f) || !(std::min({a.inverse_depth, b.inverse_depth, c.inverse_depth}) > 0.0f) ||
      std::max({a.cosine, b.cosine, c.cosine}) < least_cosine) {
    return;
  }
  const auto first = [](float x, int least) {
    return std::max(least, static_cast<int>(std::ceil(std::max(x, -1.0f))));
  };
  const auto last = [](float x, int most) {
    return x < static_cast<float>(most) ? static_cast<int>(std::floor(x)) : most;
  };
  const int left = first(std::min({a.x_px, b.x_px, c.x_px}), box_.left);
  const int right = last(std::max({a.x_px, b.x_px, c.x_px}), box_.right);
  const int top = first(std::min({a.y_px, b.y_px, c.y_px}), box_.top);
  const int bottom = last(std::max({a.y_px, b.y_px, c.y_px}), box_.bottom);
  const float per_area = 1.0f / area;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      // Weights on the image, then on the surface.
      const float dx = static_cast<float>(x) - a.x_px;
      const float dy = static_cast<float>(y) - a.y_px;
      const float at_b = (dy * (c.x_px - a.x_px) - dx * (c.y_px - a.y_px)) * per_area;
      const float at_c = (dx * (b.y_px - a.y_px) - dy * (b.x_px - a.x_px)) * per_area;
      const float at_a = 1.0f - at_b - at_c;
      if (std::min({at_a, at_b, at_c}) < 0.0f) continue;
      const float near_a = at_a * a.inverse_depth;
      const float near_b = at_b * b.inverse_depth;
      const float near_c = at_c * c.inverse_depth;
      const float inverse_depth = near_a + near_b + near_c;
      if (whole_[static_cast<std::size_t>(y - box_.top) * row_ +
                 static_cast<std::size_t>(x - box_.left)] == 0 ||
          depth_.at(x, y) > inverse_depth * (1.0f + step_)) {
        continue;
      }
      const float depth_m = 1.0f / inverse_depth;
      SurfacePixel pixel{x, y, {near_a * depth_m, near_b * depth_m, near_c * depth_m}, 0.0f};
      pixel.cosine = pixel.weight[0] * a.cosine + pixel.weight[1] * b.cosine +
                     pixel.weight[2] * c.cosine;
      if (pixel.cosine >= least_cosine) visit(pixel);
    }
  }
}

}  // namespace sheen::fitting::detail
