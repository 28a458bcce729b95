// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "core/visibility/z_buffer.h"
#include "fitting/detail/four.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::detail {

/// A vertex in a view.
struct alignas(16) SeenVertex {
  float x_px, y_px;
  float inverse_depth;  ///< 1/m; 0 where it has no pixel
  float cosine;         ///< between normal and view
};

/// A triangle in a view, its front on the image.
using SeenTriangle = std::array<SeenVertex, 3>;

/// Four pixels of a row, side by side.
struct FourPixels {
  int x_px, y_px;  ///< of the first
  unsigned shown;  ///< bit i: the centre of the i-th shows the triangle. Nothing else holds then:
  FourWeights weight;  ///< on the surface
  Four cosine;         ///< between normal and view, > 0
};

/// Where four points of a triangle are seen.
struct FourPlaces {
  unsigned seen;    ///< bit i: the i-th is. Nothing else holds of those that are not:
  Four x_px, y_px;  ///< a pixel or more from the border
  Four cosine;      ///< between normal and view, > 0
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

  /// Whether a triangle, which something may hide, is turned towards the camera, not at a grazing
  /// angle, and has a pixel for every corner. Only then may it be asked for.
  [[nodiscard]] bool is_front(std::size_t triangle_idx) const {
    return is_front_[triangle_idx] != 0;
  }
  [[nodiscard]] SeenTriangle triangle(std::size_t triangle_idx) const {
    const auto& vertex = mesh_.triangles[triangle_idx];
    return {vertices_[vertex[0]], vertices_[vertex[1]], vertices_[vertex[2]]};
  }

  /// Memory answers late: asks it for what `triangle` will need.
  void prefetch(std::size_t triangle_idx) const {
    if (is_front_[triangle_idx] == 0) return;
    for (const std::uint32_t vertex : mesh_.triangles[triangle_idx]) {
      __builtin_prefetch(&vertices_[vertex]);
    }
  }

  /// Where points of a triangle are seen.
  [[nodiscard]] FourPlaces places(const SeenTriangle& triangle, const FourWeights& weight) const;

  /// Whether a pixel around a place shows nothing of the mesh.
  [[nodiscard]] bool is_at_outline(float x_px, float y_px) const;

  /// Calls `visit(FourPixels)` for all pixels that show the triangle, row by row. May be called
  /// from several threads at once.
  template <typename Visit>
  void for_pixels(const SeenTriangle& triangle, const Visit& visit) const;

 private:
  static constexpr float kLeastCosine = 0.2f;  ///< as SamplingLimits

  void project(const core::Observation& observation);
  void find_fronts();
  [[nodiscard]] core::PixelBox box_of(const core::Observation& observation) const;
  void find_limits();
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y - box_.top) * row_ + static_cast<std::size_t>(x - box_.left);
  }

  const core::Mesh& mesh_;
  int threads_;
  core::ZBuffer depth_;
  std::vector<SeenVertex> vertices_;
  std::vector<std::uint8_t> is_front_;  ///< of the triangles, 1 or 0
  core::PixelBox box_;                  ///< pixels that may be visited
  float step_ = 0;                  ///< angle of a pixel: change of depth per pixel at 45 degrees
  std::size_t row_ = 0;             ///< numbers in a row of the two that follow, which hold the box
  std::vector<float> pixel_limit_;  ///< inverse depth that the pixel shows; infinite where it mixes
  std::vector<float>
      place_limit_;  ///< the same for places between it, right, below and below right
};

SHEEN_INLINE FourPlaces ViewRaster::places(const SeenTriangle& triangle,
                                           const FourWeights& weight) const {
  const auto& [a, b, c] = triangle;
  // Weights on the surface, then on the image.
  const Four part_a = weight[0] * (1.0f / a.inverse_depth);
  const Four part_b = weight[1] * (1.0f / b.inverse_depth);
  const Four part_c = weight[2] * (1.0f / c.inverse_depth);
  const Four inverse_depth = 1.0f / (part_a + part_b + part_c);
  FourPlaces places{};
  places.x_px = (part_a * a.x_px + part_b * b.x_px + part_c * c.x_px) * inverse_depth;
  places.y_px = (part_a * a.y_px + part_b * b.y_px + part_c * c.y_px) * inverse_depth;
  places.cosine = weight[0] * a.cosine + weight[1] * b.cosine + weight[2] * c.cosine;
  const FourInts within = (places.cosine >= kLeastCosine) &
                          (places.x_px >= static_cast<float>(box_.left)) &
                          (places.x_px < static_cast<float>(box_.right)) &
                          (places.y_px >= static_cast<float>(box_.top)) &
                          (places.y_px < static_cast<float>(box_.bottom));
  // The four pixels around must show one surface, and nothing nearer than the point: within a pixel
  // the surface rises by tan = sqrt(1 - c^2) / c steps.
  const Four cosine = within ? places.cosine : Four{1, 1, 1, 1};
  const Four rise = 1.0f + 2.0f * roots(greater(1.0f - cosine * cosine, Four{})) / cosine;
  const Four limit = (1.0f + rise * step_) * inverse_depth;
  const FourInts x = as_ints(within ? places.x_px : Four{});
  const FourInts y = as_ints(within ? places.y_px : Four{});
  for_bits(bits_of(within), [&](std::size_t i) SHEEN_INLINE_LAMBDA {
    const bool seen = place_limit_[at(x[i], y[i])] <= limit[i];
    places.seen |= static_cast<unsigned>(seen) << i;
  });
  return places;
}

template <typename Visit>
SHEEN_INLINE void ViewRaster::for_pixels(const SeenTriangle& triangle, const Visit& visit) const {
  const auto& [a, b, c] = triangle;
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
  const float to_b_x = b.x_px - a.x_px, to_b_y = b.y_px - a.y_px;
  const float to_c_x = c.x_px - a.x_px, to_c_y = c.y_px - a.y_px;
  const float per_area = 1.0f / (to_c_x * to_b_y - to_b_x * to_c_y);
  for (int y = top; y <= bottom; ++y) {
    const float dy = static_cast<float>(y) - a.y_px;
    for (int x = left; x <= right; x += 4) {
      // Weights on the image, then on the surface.
      const Four centre = Four{0, 1, 2, 3} + static_cast<float>(x);
      const Four dx = centre - a.x_px;
      const Four at_b = (dy * to_c_x - dx * to_c_y) * per_area;
      const Four at_c = (dx * to_b_y - dy * to_b_x) * per_area;
      const Four at_a = 1.0f - at_b - at_c;
      const FourInts inside =
          (at_a >= 0.0f) & (at_b >= 0.0f) & (at_c >= 0.0f) & (centre <= static_cast<float>(right));
      if (bits_of(inside) == 0) continue;
      FourPixels pixels{
          x, y, 0, {at_a * a.inverse_depth, at_b * b.inverse_depth, at_c * c.inverse_depth}, {}};
      const Four inverse_depth = pixels.weight[0] + pixels.weight[1] + pixels.weight[2];
      const Four depth_m = 1.0f / inverse_depth;
      for (Four& weight : pixels.weight) weight *= depth_m;
      pixels.cosine =
          pixels.weight[0] * a.cosine + pixels.weight[1] * b.cosine + pixels.weight[2] * c.cosine;
      pixels.shown =
          bits_of(inside & (pixels.cosine >= kLeastCosine) &
                  (load_four(&pixel_limit_[at(x, y)]) <= inverse_depth * (1.0f + step_)));
      if (pixels.shown != 0) visit(pixels);
    }
  }
}

}  // namespace sheen::fitting::detail
