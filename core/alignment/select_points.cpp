// SPDX-License-Identifier: MIT
#include "core/alignment/select_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sheen::core {
namespace {

struct Candidate {
  double gradient;
  std::uint32_t vertex_idx;
};

double distance_px(const VertexView& view, std::uint32_t a, std::uint32_t b) {
  return std::hypot(static_cast<double>(view.x_px[a] - view.x_px[b]),
                    static_cast<double>(view.y_px[a] - view.y_px[b]));
}

/// Whether every vertex reached from `start` over edges, up to `radius_px` away, is visible.
/// `reached` is scratch space.
bool is_inside(const VertexView& view, const VertexNeighbours& neighbours, std::uint32_t start,
               double radius_px, std::vector<std::uint32_t>& reached) {
  constexpr std::size_t most = 48;  // of a mesh far finer than the image: near enough
  reached.assign(1, start);
  for (std::size_t i = 0; i < reached.size() && reached.size() < most; ++i) {
    for (const std::uint32_t next : neighbours.of(reached[i])) {
      if (view.rejection[next] != VertexRejection::none) return false;
      if (distance_px(view, start, next) > radius_px) continue;
      if (std::find(reached.begin(), reached.end(), next) == reached.end()) {
        reached.push_back(next);
      }
    }
  }
  return true;
}

}  // namespace

std::optional<cv::Rect> visible_region(const VertexView& view, int margin_px) {
  float left = INFINITY;
  float top = INFINITY;
  float right = -INFINITY;
  float bottom = -INFINITY;
  for (std::size_t i = 0; i < view.rejection.size(); ++i) {
    if (view.rejection[i] != VertexRejection::none) continue;
    left = std::min(left, view.x_px[i]);
    right = std::max(right, view.x_px[i]);
    top = std::min(top, view.y_px[i]);
    bottom = std::max(bottom, view.y_px[i]);
  }
  if (!(left <= right)) return std::nullopt;
  const cv::Point corner(static_cast<int>(left) - margin_px, static_cast<int>(top) - margin_px);
  const cv::Point end(static_cast<int>(right) + margin_px + 1,
                      static_cast<int>(bottom) + margin_px + 1);
  return cv::Rect(corner, end);
}

void select_points(const VertexView& view, const VertexNeighbours& neighbours,
                   const std::vector<std::uint8_t>& usable, const GradientImage& image,
                   const SelectionLimits& limits, std::vector<std::uint32_t>& selected) {
  assert(usable.size() == view.rejection.size());
  // Rank by gradient; equal ones by index, so that the choice is one.
  std::vector<Candidate> candidates;
  for (std::uint32_t i = 0; i < view.rejection.size(); ++i) {
    if (view.rejection[i] != VertexRejection::none || usable[i] == 0) continue;
    const auto reading =
        image.read({static_cast<double>(view.x_px[i]), static_cast<double>(view.y_px[i])});
    if (!reading) continue;
    const double gradient = reading->gradient.norm();
    if (gradient >= limits.min_gradient) candidates.push_back({gradient, i});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.gradient != b.gradient ? a.gradient > b.gradient : a.vertex_idx < b.vertex_idx;
  });

  // Take the strongest that stand away from the silhouette.
  selected.clear();
  std::vector<std::uint32_t> reached;
  for (const Candidate& candidate : candidates) {
    if (selected.size() == limits.max_points) break;
    if (is_inside(view, neighbours, candidate.vertex_idx, static_cast<double>(limits.silhouette_px),
                  reached)) {
      selected.push_back(candidate.vertex_idx);
    }
  }
  std::sort(selected.begin(), selected.end());
}

}  // namespace sheen::core
