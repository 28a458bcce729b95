// SPDX-License-Identifier: MIT
#include "reconstruction/hull/visual_hull.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/views/bilinear.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace sheen::reconstruction {
namespace {

constexpr std::size_t kFewestViews = 5;
constexpr std::size_t kOneKnownIn = 4;  // of all views: what stands on the sheet is seen by most
constexpr float kUnknown_px = -3000;    // below: silhouette_distance says that nothing is known
constexpr float kOutside_m = 1;
constexpr std::size_t kMostDisagreeing = 25;

/// The k largest of the values offered, the smallest of them first to know.
class Largest {
 public:
  explicit Largest(int k) : k_(static_cast<std::size_t>(k)) { values_.fill(-1e9F); }
  void offer(float value) {
    if (value <= values_[k_ - 1]) return;
    std::size_t i = k_ - 1;
    for (; i > 0 && values_[i - 1] < value; --i) values_[i] = values_[i - 1];
    values_[i] = value;
  }
  [[nodiscard]] float kth() const { return values_[k_ - 1]; }

 private:
  std::size_t k_;
  std::array<float, kMostDisagreeing> values_{};
};

float vote(const ViewSet& views, const std::vector<OutlineVote>& outlines,
           const CarvingVotes& votes, const Eigen::Vector3f& point) {
  Largest beyond_blur(votes.wrong);
  Largest surely(votes.wrong + (votes.blur_px > 0 ? 1 : 0));
  Largest all(votes.guesses_wrong);
  std::size_t known = 0;
  for (std::size_t v = 0; v < views.views.size(); ++v) {
    const Projection& project = views.views[v].project;
    const auto pixel = project(point);
    if (!pixel || !project.in_image(pixel, 1)) continue;
    const float distance_px = bilinear_value(outlines[v].distance, pixel.x_px, pixel.y_px);
    if (distance_px < kUnknown_px) continue;
    ++known;
    const float distance_m = distance_px / project.px_per_m(pixel.depth_m);
    all.offer(distance_m);
    if (outlines[v].is_guessed.at<std::uint8_t>(static_cast<int>(pixel.y_px),
                                                static_cast<int>(pixel.x_px)) == 0) {
      surely.offer(distance_m);
      beyond_blur.offer(distance_m - votes.blur_px / project.px_per_m(pixel.depth_m));
    }
  }
  if (known < std::max(kFewestViews, views.views.size() / kOneKnownIn)) return kOutside_m;
  return std::max({beyond_blur.kth(), surely.kth(), all.kth()});
}

}  // namespace

void carve_hull(const ViewSet& views, const std::vector<OutlineVote>& outlines,
                const CarvingVotes& votes, const DistanceGrid* coarse, float band_m, int threads,
                DistanceGrid& grid) {
  assert(votes.wrong >= 1 && votes.wrong <= votes.guesses_wrong &&
         votes.guesses_wrong < static_cast<int>(kMostDisagreeing));
  core::parallel_for(grid.count(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f point = grid.point(i);
      if (coarse != nullptr) {
        const float known = coarse->value_at(point);
        if (std::abs(known) > band_m) {
          grid[i] = known;
          continue;
        }
      }
      grid[i] = vote(views, outlines, votes, point);
    }
  });
}

Components find_components(const DistanceGrid& grid) {
  Components found;
  found.of_point.assign(grid.count(), -1);
  const auto nx = static_cast<std::size_t>(grid.size().x());
  const auto ny = static_cast<std::size_t>(grid.size().y());
  const auto nz = static_cast<std::size_t>(grid.size().z());
  std::vector<std::size_t> open;
  for (std::size_t seed = 0; seed < grid.count(); ++seed) {
    if (!(grid[seed] < 0) || found.of_point[seed] >= 0) continue;
    const int number = static_cast<int>(found.parts.size());
    Component& part = found.parts.emplace_back();
    open.assign(1, seed);
    found.of_point[seed] = number;
    const auto visit = [&](std::size_t i) {
      if (!(grid[i] < 0) || found.of_point[i] >= 0) return;
      found.of_point[i] = number;
      open.push_back(i);
    };
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      ++part.points;
      part.box.extend(grid.point(i));
      const std::size_t x = i % nx;
      const std::size_t y = i / nx % ny;
      const std::size_t z = i / nx / ny;
      if (x > 0) visit(i - 1);
      if (x + 1 < nx) visit(i + 1);
      if (y > 0) visit(i - nx);
      if (y + 1 < ny) visit(i + nx);
      if (z > 0) visit(i - nx * ny);
      if (z + 1 < nz) visit(i + nx * ny);
    }
  }
  // Number them by size.
  std::vector<int> order(found.parts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return found.parts[static_cast<std::size_t>(a)].points >
           found.parts[static_cast<std::size_t>(b)].points;
  });
  std::vector<int> rank(order.size());
  std::vector<Component> sorted;
  for (std::size_t r = 0; r < order.size(); ++r) {
    rank[static_cast<std::size_t>(order[r])] = static_cast<int>(r);
    sorted.push_back(found.parts[static_cast<std::size_t>(order[r])]);
  }
  found.parts = std::move(sorted);
  for (int& number : found.of_point) {
    if (number >= 0) number = rank[static_cast<std::size_t>(number)];
  }
  return found;
}

Components find_standing(float foot_m, DistanceGrid& grid) {
  const Components all = find_components(grid);
  for (std::size_t i = 0; i < grid.count(); ++i) {
    const int own = all.of_point[i];
    if (own >= 0 && all.parts[static_cast<std::size_t>(own)].box.min().z() > foot_m) {
      grid[i] = grid.cell_m();
    }
  }
  return find_components(grid);
}

void keep_components(const Components& components, const std::vector<int>& kept,
                     DistanceGrid& grid) {
  for (std::size_t i = 0; i < grid.count(); ++i) {
    const int own = components.of_point[i];
    if (own >= 0 && std::ranges::find(kept, own) == kept.end()) grid[i] = grid.cell_m();
  }
}

}  // namespace sheen::reconstruction
