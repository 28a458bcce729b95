// SPDX-License-Identifier: MIT
#include "fitting/detail/anchor_residuals.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/sparse/columns.h"

#include <numeric>
#include <utility>

namespace sheen::fitting::detail {
namespace {

/// One channel of a triangle: from what was `said` of it to what is said `now`. Returns the
/// weighted sum of squares.
double update_channel(const sparse::Column& now, const float* weight, float weights,
                      std::size_t count, float* said, float* left) {
  float sum = 0;
  for (std::size_t row = 0; row < count; ++row) {
    left[row] += std::exchange(said[row], now.row[row]) - now.row[row];
    sum += weight[row] * left[row];
  }
  float squared = 0;
  for (std::size_t row = 0; row < count; ++row) {
    left[row] -= sum / weights;
    squared += weight[row] * left[row] * left[row];
  }
  return static_cast<double>(squared);
}

}  // namespace

AnchorResiduals::AnchorResiduals(const TriangleSamples& samples, FittedDirections fitted,
                                 int threads)
    : samples_(samples), threads_(threads), first_(1, 0) {
  for (std::size_t triangle = 0; triangle < samples.triangle_count(); ++triangle) {
    for (const TriangleSample& one : samples.of(triangle)) {
      if (fitted == FittedDirections::without_checks && is_check_direction(one.w)) continue;
      append(one);
    }
    // Where the last one lies, so that no other cell of directions is touched.
    while (weight_.size() % sparse::kRowGroup != 0) {
      append({{x_.back(), y_.back(), z_.back()}, Eigen::Vector3f::Zero(), 0.0f});
    }
    first_.push_back(weight_.size());
  }
  for (Colours& said : said_) said.fill(Numbers(weight_.size(), 0.0f));
}

void AnchorResiduals::append(const TriangleSample& sample) {
  x_.push_back(sample.w.x());
  y_.push_back(sample.w.y());
  z_.push_back(sample.w.z());
  weight_.push_back(sample.weight);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    left_[channel].push_back(sample.rgb[static_cast<Eigen::Index>(channel)]);
  }
}

double AnchorResiduals::update(const AnchoredOffsets& anchors, std::size_t level) {
  std::vector<double> squared(first_.size() - 1, 0.0);
  core::parallel_for(squared.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t triangle = begin; triangle < end; ++triangle) {
      squared[triangle] = update(anchors, level, triangle);
    }
  });
  return std::accumulate(squared.begin(), squared.end(), 0.0);
}

double AnchorResiduals::update(const AnchoredOffsets& anchors, std::size_t level,
                               std::size_t triangle) {
  const DirectionRows w = directions(triangle);
  std::array<sparse::Column, 3> now{};
  anchors.add_level(level, triangle, samples_.middle(triangle), w,
                    {now[0].row, now[1].row, now[2].row});
  const std::size_t first = first_[triangle];
  const float* const weight = weight_.data() + first;
  const float weights = std::accumulate(weight, weight + w.count, 0.0f);
  if (!(weights > 0.0f)) return 0;
  double squared = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    squared += update_channel(now[channel], weight, weights, w.count,
                              said_[level][channel].data() + first, left_[channel].data() + first);
  }
  return squared;
}

AnchorResiduals::Rows AnchorResiduals::of(std::size_t triangle) const {
  const std::size_t first = first_[triangle];
  return {directions(triangle),
          weight_.data() + first,
          {left_[0].data() + first, left_[1].data() + first, left_[2].data() + first}};
}

DirectionRows AnchorResiduals::directions(std::size_t triangle) const {
  const std::size_t first = first_[triangle];
  return {x_.data() + first, y_.data() + first, z_.data() + first, first_[triangle + 1] - first};
}

}  // namespace sheen::fitting::detail
