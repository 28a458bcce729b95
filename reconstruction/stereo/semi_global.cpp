// SPDX-License-Identifier: MIT
#include "reconstruction/stereo/semi_global.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::reconstruction {
namespace {

constexpr float kStepCost = 0.04F;
constexpr float kJumpCost = 0.35F;
constexpr float kTornSteps = 4;

struct Direction {
  int x = 0;
  int y = 0;
};
constexpr std::array<Direction, kMatchingPaths> kDirections{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};

/// Least costs of the path to a pixel from that of the pixel before it.
void continue_path(const float* costs, const float* before, std::size_t steps, float* path) {
  const float least = *std::min_element(before, before + steps);
  for (std::size_t k = 0; k < steps; ++k) {
    float best = std::min(before[k], least + kJumpCost);
    if (k > 0) best = std::min(best, before[k - 1] + kStepCost);
    if (k + 1 < steps) best = std::min(best, before[k + 1] + kStepCost);
    path[k] = costs[k] + best - least;
  }
}

}  // namespace

std::vector<float> sum_over_paths(const MatchingCosts& costs, const std::vector<float>& origin_m,
                                  float step_m) {
  const std::size_t steps = costs.steps;
  const int width = costs.size.width;
  const int height = costs.size.height;
  std::vector<float> sums(costs.values.size(), 0.0F);
  std::array<std::vector<float>, 2> rows;  // of paths: this row's and that of the row before
  for (auto& row : rows) row.resize(static_cast<std::size_t>(width) * steps);
  for (const Direction& direction : kDirections) {
    for (int row = 0; row < height; ++row) {
      const int y = direction.y < 0 ? height - 1 - row : row;
      std::swap(rows[0], rows[1]);
      for (int column = 0; column < width; ++column) {
        const int x = direction.x < 0 ? width - 1 - column : column;
        const int x_before = x - direction.x;
        const int y_before = y - direction.y;
        const auto i = static_cast<std::size_t>(y * width + x);
        float* const path = rows[0].data() + static_cast<std::size_t>(x) * steps;
        const float* const own = costs.values.data() + i * steps;
        const bool goes_on =
            x_before >= 0 && x_before < width && y_before >= 0 && y_before < height &&
            std::abs(origin_m[i] -
                     origin_m[static_cast<std::size_t>(y_before * width + x_before)]) <
                kTornSteps * step_m;
        if (goes_on) {
          const auto& from = direction.y == 0 ? rows[0] : rows[1];
          continue_path(own, from.data() + static_cast<std::size_t>(x_before) * steps, steps, path);
        } else {
          std::copy_n(own, steps, path);
        }
        for (std::size_t k = 0; k < steps; ++k) sums[i * steps + k] += path[k];
      }
    }
  }
  return sums;
}

}  // namespace sheen::reconstruction
