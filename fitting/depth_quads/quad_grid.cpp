// SPDX-License-Identifier: MIT
#include "fitting/depth_quads/quad_grid.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::fitting::depth_quads {
namespace {

constexpr std::size_t kMostAround = 81;

/// Median of the depths around a pixel that has one, the lower one of an even number: of a jump
/// between two surfaces the nearer side.
float median_around(const cv::Mat& depth_m, const cv::Point& pixel, int side) {
  std::array<float, kMostAround> around{};
  std::size_t count = 0;
  const cv::Rect window =
      cv::Rect(pixel.x - side / 2, pixel.y - side / 2, side, side) & cv::Rect({}, depth_m.size());
  for (int y = window.y; y < window.y + window.height; ++y) {
    for (int x = window.x; x < window.x + window.width; ++x) {
      const float depth = depth_m.at<float>(y, x);
      if (depth > 0.0f) around[count++] = depth;
    }
  }
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

std::uint16_t code_of(float depth_m, const QuadDepths& range) {
  constexpr float steps = 65534.0f;
  const float span_m = range.farthest_m - range.nearest_m;
  const float part = span_m > 0.0f ? (depth_m - range.nearest_m) / span_m : 0.0f;
  return static_cast<std::uint16_t>(1 + std::lround(std::clamp(part, 0.0f, 1.0f) * steps));
}

}  // namespace

std::vector<QuadLevel> quad_levels(const cv::Size& crop, int spacing_px, int levels) {
  std::vector<QuadLevel> all;
  for (int s = spacing_px; levels > 0; --levels, s = 2 * s + 1) {
    all.push_back({s, (crop.width + s - 1) / s, (crop.height + s - 1) / s});
  }
  return all;
}

QuadDepths quad_depths(const cv::Mat& depth_m, std::span<const QuadLevel> levels, int median) {
  QuadDepths depths;
  double nearest = 0;
  double farthest = 0;
  cv::minMaxIdx(depth_m, &nearest, &farthest, nullptr, nullptr, depth_m > 0.0f);
  depths.nearest_m = static_cast<float>(nearest);
  depths.farthest_m = static_cast<float>(farthest);
  for (const auto& [s, columns, rows] : levels) {
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        // A last cell whose middle lies outside is looked at on the border.
        const cv::Point middle(std::min(i * s + s / 2, depth_m.cols - 1),
                               std::min(j * s + s / 2, depth_m.rows - 1));
        const float here = depth_m.at<float>(middle);
        depths.codes.push_back(here > 0.0f ? code_of(median_around(depth_m, middle, median), depths)
                                           : std::uint16_t{0});
      }
    }
  }
  return depths;
}

}  // namespace sheen::fitting::depth_quads
