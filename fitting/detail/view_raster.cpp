// SPDX-License-Identifier: MIT
#include "fitting/detail/view_raster.h"

#include "core/concurrency/parallel_for.h"
#include "core/visibility/raster_kernels.h"

namespace sheen::fitting::detail {
namespace {

/// Pixels nearer to the image's border are not visited, as SamplingLimits has it.
constexpr int kBorder_px = 2;

}  // namespace

ViewRaster::ViewRaster(const core::Mesh& mesh, int threads)
    : mesh_(mesh),
      threads_(threads),
      depth_(mesh, threads, core::raster_kernel_sets().front()),
      vertices_(mesh.positions.size()),
      is_front_(mesh.triangles.size()) {}

void ViewRaster::set_view(const core::Observation& observation) {
  project(observation);
  find_fronts();
  box_ = box_of(observation);
  step_ = 1.0f / static_cast<float>(observation.camera.intrinsics().focal_px.minCoeff());
  if (box_.right < box_.left || box_.bottom < box_.top) return;
  // A pixel more on every side: neighbours are compared. That large triangles are drawn with
  // straight edges does not matter: the pixels are found by the same edges.
  static_cast<void>(depth_.draw(observation.view,
                                core::eye_in_object(observation.camera_from_object),
                                {box_.left - 1, box_.top - 1, box_.right + 1, box_.bottom + 1}));
  find_whole_pixels();
}

// A surface seen at a cosine of .2 changes by 5 steps per pixel; where the change is much larger a
// pixel mixes two surfaces.
void ViewRaster::find_whole_pixels() {
  constexpr float jump_steps = 12.0f;
  row_ = static_cast<std::size_t>(box_.right - box_.left + 1);
  const auto rows = static_cast<std::size_t>(box_.bottom - box_.top + 1);
  whole_.assign(row_ * rows, 0);
  core::parallel_for(
      rows, threads_,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const int y = box_.top + static_cast<int>(row);
          for (int x = box_.left; x <= box_.right; ++x) {
            const float here = depth_.at(x, y);
            const float limit = jump_steps * step_ * here;
            const auto continues = [&](float other) { return std::abs(other - here) <= limit; };
            const bool whole = here > 0.0f && continues(depth_.at(x - 1, y)) &&
                               continues(depth_.at(x + 1, y)) && continues(depth_.at(x, y - 1)) &&
                               continues(depth_.at(x, y + 1));
            whole_[row * row_ + static_cast<std::size_t>(x - box_.left)] = whole ? 1 : 0;
          }
        }
      },
      16);
}

void ViewRaster::project(const core::Observation& observation) {
  const core::VertexView& view = observation.view;
  const Eigen::Vector3f eye = core::eye_in_object(observation.camera_from_object);
  core::parallel_for(vertices_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f towards_eye = eye - mesh_.positions[i];
      const float depth_m = view.depth_m[i];
      vertices_[i] = {view.x_px[i], view.y_px[i], depth_m > 0.0f ? 1.0f / depth_m : 0.0f,
                      mesh_.normals[i].dot(towards_eye) / towards_eye.norm()};
    }
  });
}

/// Box of all projected vertices within the image.
core::PixelBox ViewRaster::box_of(const core::Observation& observation) const {
  float left = 1e9f;
  float top = 1e9f;
  float right = -1e9f;
  float bottom = -1e9f;
  for (const SeenVertex& vertex : vertices_) {
    if (!(vertex.inverse_depth > 0.0f)) continue;
    left = std::min(left, vertex.x_px);
    right = std::max(right, vertex.x_px);
    top = std::min(top, vertex.y_px);
    bottom = std::max(bottom, vertex.y_px);
  }
  const int last_x = observation.image.cols - 1 - kBorder_px;
  const int last_y = observation.image.rows - 1 - kBorder_px;
  const auto within = [](float x, int most) {
    return static_cast<int>(std::clamp(x, 0.0f, static_cast<float>(std::max(most, 0))));
  };
  return {std::max(within(left, last_x), kBorder_px), std::max(within(top, last_y), kBorder_px),
          std::min(within(right + 1.0f, last_x), last_x),
          std::min(within(bottom + 1.0f, last_y), last_y)};
}

void ViewRaster::find_fronts() {
  core::parallel_for(is_front_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& vertex = mesh_.triangles[t];
      const SeenVertex& a = vertices_[vertex[0]];
      const SeenVertex& b = vertices_[vertex[1]];
      const SeenVertex& c = vertices_[vertex[2]];
      const float area =
          (c.x_px - a.x_px) * (b.y_px - a.y_px) - (b.x_px - a.x_px) * (c.y_px - a.y_px);
      // Comparisons are written so that a number that is not one fails. No branch: which triangles
      // are fronts is hard to foresee.
      const bool projected = std::min({a.inverse_depth, b.inverse_depth, c.inverse_depth}) > 0.0f;
      const bool frontal = std::max({a.cosine, b.cosine, c.cosine}) >= kLeastCosine;
      is_front_[t] = static_cast<std::uint8_t>(projected & frontal & (area > 0.0f));
    }
  });
}

std::optional<SeenTriangle> ViewRaster::triangle(std::size_t triangle_idx) const {
  if (is_front_[triangle_idx] == 0) return std::nullopt;
  const auto& vertex = mesh_.triangles[triangle_idx];
  SeenTriangle triangle{{vertices_[vertex[0]], vertices_[vertex[1]], vertices_[vertex[2]]}};
  for (std::size_t i = 0; i < 3; ++i) triangle.depth_m[i] = 1.0f / triangle.corner[i].inverse_depth;
  return triangle;
}

bool ViewRaster::is_at_outline(float x_px, float y_px) const {
  if (!(x_px >= static_cast<float>(box_.left) && x_px <= static_cast<float>(box_.right) &&
        y_px >= static_cast<float>(box_.top) && y_px <= static_cast<float>(box_.bottom))) {
    return false;
  }
  const auto x = static_cast<int>(std::lround(x_px));
  const auto y = static_cast<int>(std::lround(y_px));
  for (int below = -1; below <= 1; ++below) {
    for (int right = -1; right <= 1; ++right) {
      if (depth_.at(x + right, y + below) == 0.0f) return true;
    }
  }
  return false;
}

}  // namespace sheen::fitting::detail
