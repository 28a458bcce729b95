// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/view_graph.h"

#include "core/directions/view_sphere.h"
#include "fitting/multi_eigenspace/in_steps.h"

#include <algorithm>

namespace sheen::fitting::multi_eigenspace {

ViewGraph::ViewGraph(std::span<const Eigen::Vector3d> directions)
    : directions_(directions), neighbours_(directions.size()), mixed_with_(directions.size()) {
  const core::ViewSphere sphere({directions.begin(), directions.end()});
  for (const auto& corners : sphere.triangles()) {
    for (std::size_t c = 0; c < 3; ++c) join(corners[c], corners[(c + 1) % 3]);
  }
  for (const auto& [a, b] : sphere.borders()) join(a, b);
  const auto cosine = [&](std::uint32_t a, std::uint32_t b) {
    constexpr int bits = 40;
    return in_steps(directions_[a].dot(directions_[b]), bits);
  };
  for (std::uint32_t i = 0; i < directions.size(); ++i) {
    // One in the same place as another has no triangle of its own.
    if (mixed_with_[i].empty()) {
      std::uint32_t nearest = i;
      for (std::uint32_t k = 0; k < directions.size(); ++k) {
        if (k != i && (nearest == i || cosine(i, k) > cosine(i, nearest))) nearest = k;
      }
      join(i, nearest);
    }
  }
  for (std::uint32_t i = 0; i < directions.size(); ++i) {
    for (const std::uint32_t next : mixed_with_[i]) {
      if (!has_view_between(i, next)) neighbours_[i].push_back(next);
    }
    std::ranges::sort(neighbours_[i], [&](std::uint32_t a, std::uint32_t b) {
      return cosine(i, a) != cosine(i, b) ? cosine(i, a) > cosine(i, b) : a < b;
    });
  }
}

void ViewGraph::join(std::uint32_t a, std::uint32_t b) {
  if (a == b || std::ranges::find(mixed_with_[a], b) != mixed_with_[a].end()) return;
  mixed_with_[a].push_back(b);
  mixed_with_[b].push_back(a);
}

/// Within the circle that has the edge as its diameter, or on it but in neither end's place. If
/// there is one, then also among those that share an edge with an end.
bool ViewGraph::has_view_between(std::uint32_t a, std::uint32_t b) const {
  const Eigen::Vector3d middle = directions_[a] + directions_[b];
  const auto is_between = [&](std::uint32_t view) {
    constexpr double rounding = 1e-9;
    const Eigen::Vector3d& one = directions_[view];
    return one.dot(middle) > directions_[a].dot(middle) - rounding &&
           std::max(one.dot(directions_[a]), one.dot(directions_[b])) < 1 - rounding;
  };
  return std::ranges::any_of(mixed_with_[a], is_between) ||
         std::ranges::any_of(mixed_with_[b], is_between);
}

}  // namespace sheen::fitting::multi_eigenspace
