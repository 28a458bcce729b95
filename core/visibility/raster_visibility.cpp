// SPDX-License-Identifier: MIT
#include "core/visibility/raster_visibility.h"

#include "core/concurrency/parallel_for.h"
#include "core/visibility/distorted_edges.h"
#include "core/visibility/ray_caster.h"
#include "core/visibility/z_buffer.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheen::core {
namespace {

/// How much nearer than a vertex a pixel must be to hide it, in steps of one pixel along the
/// surface: within a pixel in either direction a plane rises by at most 1.4 steps.
constexpr float kBiasSteps = 2.0f;
constexpr float kRelativeBias = 1e-5f;  // rounding of depths

class RasterVisibility final : public Visibility {
 public:
  RasterVisibility(const Mesh& mesh, int threads, const RasterKernels& kernels)
      : caster_(mesh),
        raster_(mesh, threads, kernels),
        positions_(mesh.positions),
        threads_(threads) {}

  void reject_occluded(const CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                       VertexView& view) override {
    const Eigen::Vector3f eye = eye_in_object(camera_from_object);
    const PixelBox box = choose_candidates(view);
    if (candidates_.empty()) return;
    const bool map_holds = raster_.draw(view, eye, box) && all_straight(camera, camera_from_object);
    const float pixel_angle = 1.0f / static_cast<float>(camera.intrinsics().focal_px.minCoeff());
    parallel_for(candidates_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        const std::uint32_t i = candidates_[c];
        const Answer answer = map_holds ? ask_map(view, i, pixel_angle) : Answer::doubt;
        if (answer == Answer::hidden ||
            (answer == Answer::doubt && caster_.vertex_hidden(i, eye))) {
          view.rejection[i] = VertexRejection::occluded;
        }
      }
    });
  }

 private:
  enum class Answer { seen, hidden, doubt };

  /// Lists the vertices in question and returns the box of pixels around all of them.
  PixelBox choose_candidates(const VertexView& view) {
    const std::size_t count = view.rejection.size();
    candidates_.resize(count);
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < count; ++i) {
      candidates_[chosen] = static_cast<std::uint32_t>(i);
      chosen += view.rejection[i] == VertexRejection::none ? 1 : 0;
    }
    candidates_.resize(chosen);
    if (candidates_.empty()) return {};
    float left = view.x_px[candidates_[0]], right = left;
    float top = view.y_px[candidates_[0]], bottom = top;
    for (const std::uint32_t i : candidates_) {
      left = std::min(left, view.x_px[i]);
      right = std::max(right, view.x_px[i]);
      top = std::min(top, view.y_px[i]);
      bottom = std::max(bottom, view.y_px[i]);
    }
    return {static_cast<int>(left), static_cast<int>(top), static_cast<int>(right) + 1,
            static_cast<int>(bottom) + 1};
  }

  [[nodiscard]] bool all_straight(const CameraModel& camera,
                                  const Eigen::Isometry3d& camera_from_object) const {
    return std::none_of(raster_.large_triangles().begin(), raster_.large_triangles().end(),
                        [&](const LargeTriangle& triangle) {
                          return has_distorted_edge(
                              camera, camera_from_object,
                              {positions_[triangle.corners[0]], positions_[triangle.corners[1]],
                               positions_[triangle.corners[2]]});
                        });
  }

  /// A pixel hides where depth * inverse_depth > 1 + bias, with a bias of kBiasSteps pixels times
  /// the change of depth per step across the view, relative to depth: the tangent of the angle
  /// between normal and view, whose sine is the radius on the disc of directions. Compared by
  /// squares.
  [[nodiscard]] Answer ask_map(const VertexView& view, std::uint32_t i, float pixel_angle) const {
    const float sine2 = view.u[i] * view.u[i] + view.v[i] * view.v[i];
    const float bias_px = kBiasSteps * pixel_angle;
    const auto in_front = [&, depth_m = view.depth_m[i]](float inverse_depth) {
      const float excess = depth_m * inverse_depth - (1.0f + kRelativeBias);
      return excess > 0.0f && excess * excess * (1.0f - sine2) > bias_px * bias_px * sine2;
    };
    const ZBuffer::Range found = raster_.around(view.x_px[i], view.y_px[i]);
    if (!in_front(found.greatest)) return Answer::seen;
    return in_front(found.least) ? Answer::hidden : Answer::doubt;
  }

  RayCaster caster_;
  ZBuffer raster_;
  std::vector<Eigen::Vector3f> positions_;
  int threads_;
  std::vector<std::uint32_t> candidates_;
};

}  // namespace

std::unique_ptr<Visibility> make_raster_visibility(const Mesh& mesh, int threads,
                                                   const RasterKernels& kernels) {
  return std::make_unique<RasterVisibility>(mesh, threads, kernels);
}

}  // namespace sheen::core
