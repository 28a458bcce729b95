// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/carve_roofs.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheen::reconstruction {
namespace {

constexpr std::size_t kLeastVotes = 3;
constexpr std::size_t kOneIn =
    4;  // the vote that counts: reflections look too deep from many sides
constexpr float kAtHull_px = 4;

/// How far in front of the surface the views have a point, metres along their lines of sight, at
/// most `limit_m`; those that see it farther behind have no vote.
void collect_votes(const DepthMaps& maps, const Eigen::Vector3f& point, float limit_m,
                   std::vector<float>& votes) {
  votes.clear();
  for (std::size_t v = 0; v < maps.views.size(); ++v) {
    const auto seen = maps.views[v].project(point);
    if (!seen || !maps.views[v].project.in_image(seen, 0)) continue;
    const int x = static_cast<int>(std::lround(seen.x_px));
    const int y = static_cast<int>(std::lround(seen.y_px));
    const float depth_m = maps.depth[v].at<float>(y, x);
    if (!(depth_m > 0) || seen.depth_m - depth_m > limit_m) continue;
    const bool is_hull = depth_m - maps.views[v].hull.at<float>(y, x) < kAtHull_px * maps.pixel_m;
    votes.push_back(is_hull ? -limit_m : std::min(depth_m - seen.depth_m, limit_m));
  }
}

}  // namespace

void carve_roofs(const DepthMaps& maps, float limit_m, int threads, DistanceGrid& grid) {
  core::parallel_for(grid.count(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<float> votes;
    for (std::size_t i = begin; i < end; ++i) {
      if (grid[i] > limit_m) continue;
      collect_votes(maps, grid.point(i), limit_m, votes);
      if (votes.size() < kLeastVotes) continue;
      const auto counts = votes.begin() + static_cast<std::ptrdiff_t>((votes.size() - 1) / kOneIn);
      std::nth_element(votes.begin(), counts, votes.end());
      grid[i] = std::max(grid[i], *counts);
    }
  });
}

}  // namespace sheen::reconstruction
