// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/types.hpp>

#include <cstddef>
#include <vector>

namespace sheen::reconstruction {

/// What every depth of every pixel of a rectangle costs.
struct MatchingCosts {
  cv::Size size;
  std::size_t steps = 0;      ///< depths of a pixel
  std::vector<float> values;  ///< [y][x][step], [0, 1]
};

constexpr std::size_t kMatchingPaths = 8;

/// Least costs of paths that end at a pixel and depth, summed over the eight directions from which
/// they come (Hirschmueller 2008, equations 13 and 14): steps of one depth from pixel to pixel cost
/// little, jumps more. Layout as the costs'. No path crosses a jump of `origin_m` (per pixel, what
/// its depths count from) by more than a few steps of `step_m`.
std::vector<float> sum_over_paths(const MatchingCosts& costs, const std::vector<float>& origin_m,
                                  float step_m);

}  // namespace sheen::reconstruction
