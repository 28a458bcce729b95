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
#include <optional>
#include <vector>

namespace sheen::fitting::detail {

/// A vertex in a view.
struct alignas(16) SeenVertex {
  float x_px, y_px;
  float inverse_depth;  ///< 1/m; 0 where it has no pixel
  float cosine;         ///< between normal and view
};

/// A triangle in a view, its front on the image.
struct SeenTriangle {
  std::array<SeenVertex, 3> corner;
  std::array<float, 3> depth_m{};  ///< of the corners

  /// Interpolated on the surface; the weights of the corners add up to 1.
  [[nodiscard]] float cosine(const std::array<float, 3>& weight) const {
    return weight[0] * corner[0].cosine + weight[1] * corner[1].cosine +
           weight[2] * corner[2].cosine;
  }
};

/// A pixel whose centre shows a triangle.
struct SurfacePixel {
  int x_px, y_px;
  std::array<float, 3> weight;  ///< of the triangle's corners on the surface, sum 1
  float cosine;                 ///< between normal and view, > 0
};

/// Where a view shows which part of a mesh. Places are left out that something else hides, that lie
/// at a jump of depth (their pixels mix two surfaces), near the border of the image, or that are
/// seen at a grazing angle. Keeps its storage from view to view.
class ViewRaster {
 public:
  /// `mesh` outlives it.
  ViewRaster(const core::Mesh& mesh, int threads);

  /// Looks at another view of the mesh.
  void set_view(const core::Observation& observation);

  /// A triangle, whether or not something hides it; nothing where it is turned away, edge-on, at a
  /// grazing angle or has a corner without a pixel.
  [[nodiscard]] std::optional<SeenTriangle> triangle(std::size_t triangle_idx) const;

  /// Whether `triangle` has something.
  [[nodiscard]] bool is_front(std::size_t triangle_idx) const {
    return is_front_[triangle_idx] != 0;
  }

  /// Memory answers late: asks it for what `triangle` will need.
  void prefetch(std::size_t triangle_idx) const {
    if (is_front_[triangle_idx] == 0) return;
    for (const std::uint32_t vertex : mesh_.triangles[triangle_idx]) {
      __builtin_prefetch(&vertices_[vertex]);
    }
  }

  /// Where a point of a triangle is seen, pixels; nothing where it is not. The weights of the
  /// corners add up to 1.
  [[nodiscard]] std::optional<Eigen::Vector2f> place(const SeenTriangle& triangle,
                                                     const std::array<float, 3>& weight) const;

  /// Whether a pixel around a place shows nothing of the mesh.
  [[nodiscard]] bool is_at_outline(float x_px, float y_px) const;

  /// Calls `visit(pixel)` for every pixel that shows the triangle, row by row. May be called from
  /// several threads at once.
  template <typename Visit>
  void for_each_pixel(const SeenTriangle& triangle, const Visit& visit) const;

 private:
  static constexpr float kLeastCosine = 0.2f;  ///< as SamplingLimits

  void project(const core::Observation& observation);
  void find_fronts();
  [[nodiscard]] core::PixelBox box_of(const core::Observation& observation) const;
  void find_whole_pixels();
  /// Whether the pixel shows one surface; it lies in the box.
  [[nodiscard]] bool is_whole(int x, int y) const {
    return whole_[static_cast<std::size_t>(y - box_.top) * row_ +
                  static_cast<std::size_t>(x - box_.left)] != 0;
  }

  const core::Mesh& mesh_;
  int threads_;
  core::ZBuffer depth_;
  std::vector<SeenVertex> vertices_;
  std::vector<std::uint8_t> is_front_;  ///< of the triangles, 1 or 0
  core::PixelBox box_;                  ///< pixels that may be visited
  float step_ = 0;                   ///< angle of a pixel: change of depth per pixel at 45 degrees
  std::size_t row_ = 0;              ///< pixels in a row of the box
  std::vector<std::uint8_t> whole_;  ///< 1 where the four pixels around show the same surface
};

inline std::optional<Eigen::Vector2f> ViewRaster::place(const SeenTriangle& triangle,
                                                        const std::array<float, 3>& weight) const {
  const float cosine = triangle.cosine(weight);
  if (!(cosine >= kLeastCosine)) return std::nullopt;
  // Weights on the surface, then on the image.
  float depth_m = 0;
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const SeenVertex& corner = triangle.corner[i];
    const float part_m = weight[i] * triangle.depth_m[i];
    depth_m += part_m;
    sum += part_m * Eigen::Vector2f(corner.x_px, corner.y_px);
  }
  const float inverse_depth = 1.0f / depth_m;
  const Eigen::Vector2f at_px = sum * inverse_depth;
  if (!(at_px.x() >= static_cast<float>(box_.left) && at_px.x() < static_cast<float>(box_.right) &&
        at_px.y() >= static_cast<float>(box_.top) && at_px.y() < static_cast<float>(box_.bottom))) {
    return std::nullopt;
  }
  // The four pixels around must show one surface, and nothing nearer than the point: within a pixel
  // the surface rises by tan = sqrt(1 - c^2) / c steps.
  const auto x = static_cast<int>(at_px.x());
  const auto y = static_cast<int>(at_px.y());
  const bool whole =
      is_whole(x, y) && is_whole(x + 1, y) && is_whole(x, y + 1) && is_whole(x + 1, y + 1);
  if (!whole) return std::nullopt;
  const float rise = 1.0f + 2.0f * std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine;
  if (depth_.at(x, y) > (1.0f + rise * step_) * inverse_depth) return std::nullopt;
  return at_px;
}

template <typename Visit>
void ViewRaster::for_each_pixel(const SeenTriangle& triangle, const Visit& visit) const {
  const auto& [a, b, c] = triangle.corner;
  const float area = (c.x_px - a.x_px) * (b.y_px - a.y_px) - (b.x_px - a.x_px) * (c.y_px - a.y_px);
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
      if (!is_whole(x, y) || depth_.at(x, y) > inverse_depth * (1.0f + step_)) continue;
      const float depth_m = 1.0f / inverse_depth;
      SurfacePixel pixel{x, y, {near_a * depth_m, near_b * depth_m, near_c * depth_m}, 0.0f};
      pixel.cosine = triangle.cosine(pixel.weight);
      if (pixel.cosine >= kLeastCosine) visit(pixel);
    }
  }
}

}  // namespace sheen::fitting::detail
