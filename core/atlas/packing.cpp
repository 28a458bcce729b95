// SPDX-License-Identifier: MIT
#include "core/atlas/packing.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace sheen::core {
namespace {

/// Upper outline of what has been placed: steps from left to right.
class Skyline {
 public:
  explicit Skyline(int width) : steps_{{0, width, 0}} {}

  /// Places a rectangle where its upper side comes out lowest; `size.x` <= width.
  Eigen::Vector2i place(const Eigen::Vector2i& size) {
    std::size_t best = steps_.size();
    int lowest = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const int floor = floor_from(i, size.x());
      if (floor < 0 || floor >= lowest) continue;
      lowest = floor;
      best = i;
    }
    assert(best < steps_.size());
    const Eigen::Vector2i origin(steps_[best].x, lowest);
    raise(best, {origin.x(), size.x(), lowest + size.y()});
    return origin;
  }

 private:
  struct Step {
    int x, width, y;
  };

  /// Height on which a rectangle stands whose left side is that of step i; -1 beyond the right end.
  [[nodiscard]] int floor_from(std::size_t i, int width) const {
    int floor = 0;
    for (int left = width; left > 0; ++i) {
      if (i == steps_.size()) return -1;
      floor = std::max(floor, steps_[i].y);
      left -= steps_[i].width;
    }
    return floor;
  }

  /// Inserts a step at i and cuts what lies under it.
  void raise(std::size_t i, const Step& step) {
    const int end = step.x + step.width;
    std::size_t covered = i;
    while (covered < steps_.size() && steps_[covered].x + steps_[covered].width <= end) ++covered;
    if (covered < steps_.size() && steps_[covered].x < end) {
      steps_[covered].width -= end - steps_[covered].x;
      steps_[covered].x = end;
    }
    const auto from = steps_.begin() + static_cast<std::ptrdiff_t>(i);
    steps_.erase(from, steps_.begin() + static_cast<std::ptrdiff_t>(covered));
    steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(i), step);
    // Steps of one height are one.
    if (i + 1 < steps_.size() && steps_[i + 1].y == step.y) join(i);
    if (i > 0 && steps_[i - 1].y == step.y) join(i - 1);
  }

  void join(std::size_t i) {
    steps_[i].width += steps_[i + 1].width;
    steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }

  std::vector<Step> steps_;
};

}  // namespace

Packing pack_rectangles(const std::vector<Eigen::Vector2i>& sizes) {
  Packing packing;
  packing.origins.resize(sizes.size());
  if (sizes.empty()) return packing;

  // Choose the width.
  std::int64_t area = 0;
  int widest = 1;
  for (const Eigen::Vector2i& size : sizes) {
    assert(size.x() >= 1 && size.y() >= 1);
    area += static_cast<std::int64_t>(size.x()) * size.y();
    widest = std::max(widest, size.x());
  }
  constexpr double filled = 0.92;  // what the skyline reaches
  const double side = std::sqrt(static_cast<double>(area) / filled);
  packing.size.x() = std::max(widest, static_cast<int>(std::ceil(side)));

  // Place them.
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a].y() != sizes[b].y() ? sizes[a].y() > sizes[b].y() : sizes[a].x() > sizes[b].x();
  });
  Skyline skyline(packing.size.x());
  for (const std::size_t i : order) {
    packing.origins[i] = skyline.place(sizes[i]);
    packing.size.y() = std::max(packing.size.y(), packing.origins[i].y() + sizes[i].y());
  }
  return packing;
}

}  // namespace sheen::core
