// SPDX-License-Identifier: MIT
#include "capture/pose/blur.h"

#include "capture/pose/edge_profile.h"
#include "core/numerics/median.h"

#include <algorithm>

namespace sheen::capture {
namespace {

constexpr int kPositions = 9;

std::optional<double> median(std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return core::upper_median(values);
}

void measure_side(const cv::Mat& grey, const TagSide& side, double half_length_px,
                  std::vector<double>& widths) {
  for (int i = 0; i < kPositions; ++i) {
    const double t = 0.15 + 0.7 * i / (kPositions - 1);
    const auto profile = EdgeProfile::sample(grey, side.point(t), side.outward(), half_length_px);
    const auto width = profile ? profile->rise_width_px() : std::nullopt;
    if (width) widths.push_back(*width);
  }
}

std::optional<double> measure_tag(const cv::Mat& grey, const core::CameraModel& camera, int modules,
                                  const TagDetection& tag) {
  const auto& corners = tag.corners_px;
  const Eigen::Vector2d centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  std::optional<double> widest;
  for (std::size_t pair = 0; pair < 2; ++pair) {
    std::vector<double> widths;
    for (const std::size_t s : {pair, pair + 2}) {
      const TagSide side(camera, corners[s], corners[(s + 1) % 4], centre);
      const double module_px = 2 * side.outward().dot(side.point(0.5) - centre) / modules;
      measure_side(grey, side, std::clamp(0.9 * module_px, 1.5, 8.0), widths);
    }
    const auto width = median(widths);
    if (width && (!widest || *width > *widest)) widest = width;
  }
  return widest;
}

}  // namespace

std::optional<double> tag_edge_width(const cv::Mat& grey, const core::CameraModel& camera,
                                     int modules, const std::vector<TagDetection>& tags) {
  std::vector<double> widths;
  for (const TagDetection& tag : tags) {
    if (const auto width = measure_tag(grey, camera, modules, tag)) widths.push_back(*width);
  }
  return median(widths);
}

}  // namespace sheen::capture
