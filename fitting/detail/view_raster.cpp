// SPDX-License-Identifier: MIT
#include "fitting/detail/view_raster.h"

#include "core/concurrency/parallel_for.h"
#include "core/visibility/raster_kernels.h"

#include <limits>

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
  find_limits();
}

// A surface seen at a cosine of .2 changes by 5 steps per pixel; where the change is much larger a
// pixel mixes two surfaces.
void ViewRaster::find_limits() {
  constexpr float jump_steps = 12.0f;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto width = static_cast<std::size_t>(box_.right - box_.left + 1);
  const auto rows = static_cast<std::size_t>(box_.bottom - box_.top + 1);
  row_ = (width + 3) / 4 * 4 + 4;
  pixel_limit_.resize(row_ * rows);
  place_limit_.resize(row_ * rows);
  const float most_jump = jump_steps * step_;
  core::parallel_for(
      rows, threads_,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const int y = box_.top + static_cast<int>(row);
          const float* const above = depth_.from(box_.left, y - 1);
          const float* const here = depth_.from(box_.left, y);
          const float* const below = depth_.from(box_.left, y + 1);
          float* const limit = pixel_limit_.data() + row * row_;
          for (std::size_t x = 0; x < width; ++x) {
            const float most = most_jump * here[x];
            const auto jump = [&](const float* other) { return std::abs(*other - here[x]); };
            const float jumps = std::max(std::max(jump(here + x - 1), jump(here + x + 1)),
                                         std::max(jump(above + x), jump(below + x)));
            limit[x] = (here[x] > 0.0f) & (jumps <= most) ? here[x] : infinity;
          }
          std::fill(limit + width, limit + row_, infinity);
        }
      },
      16);
  core::parallel_for(
      rows, threads_,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const float* const upper = pixel_limit_.data() + row * row_;
          const float* const lower = row + 1 < rows ? upper + row_ : upper;
          float* const limit = place_limit_.data() + row * row_;
          for (std::size_t x = 0; x < width; ++x) {
            const float greatest =
                std::max(std::max(upper[x], upper[x + 1]), std::max(lower[x], lower[x + 1]));
            limit[x] = greatest < infinity ? upper[x] : infinity;
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
