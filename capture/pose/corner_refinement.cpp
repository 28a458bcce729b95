// SPDX-License-Identifier: MIT
#include "capture/pose/corner_refinement.h"

#include "capture/pose/edge_profile.h"
#include "capture/pose/side_line.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sheen::capture {
namespace {

EdgePositions measure(const cv::Mat& grey, const TagSide& side, double half_length_px, int wanted) {
  // Stay clear of the corners, where two edges melt into each other.
  constexpr double first = 0.1;
  constexpr double last = 0.9;
  EdgePositions found;
  for (int i = 0; i < wanted; ++i) {
    const double t = first + (last - first) * i / (wanted - 1);
    const auto profile = EdgeProfile::sample(grey, side.point(t), side.outward(), half_length_px);
    const auto position = profile ? profile->position_px() : std::nullopt;
    if (!position || std::abs(*position) > 0.8 * half_length_px) continue;
    found.add(t, *position);
  }
  return found;
}

/// Half length of the profiles across a side. The first round must catch corners that are a few
/// pixels off; later ones reach just over the blurred edge, since more only adds noise. Two thirds
/// of a module reach neither the code inside nor the next tag outside.
double half_length(const cv::Mat& grey, const TagSide& side, double module_px, bool is_first) {
  constexpr int probes = 5;
  const double longest_px = std::clamp(0.65 * module_px, 1.5, 6.0);
  if (is_first) return longest_px;
  double sum_px = 0;
  int count = 0;
  for (int i = 0; i < probes; ++i) {
    const auto profile =
        EdgeProfile::sample(grey, side.point(0.2 + 0.15 * i), side.outward(), longest_px);
    const auto width_px = profile ? profile->rise_width_px() : std::nullopt;
    if (!width_px) continue;
    sum_px += *width_px;
    ++count;
  }
  // 1.25 times the rise is 3.2 standard deviations of a Gaussian blur: the step is over there.
  return count == 0 ? longest_px : std::clamp(1.25 * sum_px / count, 1.5, longest_px);
}

std::optional<SideOffset> locate_side(const cv::Mat& grey, const TagSide& side, double module_px,
                                      bool is_first) {
  const double half_length_px = half_length(grey, side, module_px, is_first);
  const int wanted = std::clamp(static_cast<int>(side.length_px() / 1.5), 8,
                                static_cast<int>(EdgePositions::kMost));
  const EdgePositions positions = measure(grey, side, half_length_px, wanted);
  if (2 * positions.count < static_cast<std::size_t>(wanted)) return std::nullopt;
  return fit_line(positions);
}

}  // namespace

void refine_corners(const cv::Mat& grey, const core::CameraModel& camera, int modules,
                    std::array<Eigen::Vector2d, 4>& corners_px) {
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::Vector2d centre =
        (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]) / 4;

    // Measure each side against the line through its present corners.
    std::array<std::optional<SideOffset>, 4> offsets;
    std::array<Eigen::Vector2d, 4> outward;
    double smallest_module_px = 1e9;
    for (std::size_t s = 0; s < 4; ++s) {
      const TagSide side(camera, corners_px[s], corners_px[(s + 1) % 4], centre);
      const double module_px = 2 * side.outward().dot(side.point(0.5) - centre) / modules;
      outward[s] = side.outward();
      offsets[s] = locate_side(grey, side, module_px, round == 0);
      smallest_module_px = std::min(smallest_module_px, module_px);
    }

    // Move each corner to where its two sides meet.
    const double max_move_px = std::max(1.5, smallest_module_px);
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t before = (c + 3) % 4;
      if (!offsets[before] || !offsets[c]) continue;
      const auto move =
          meeting_point(outward[before], offsets[before]->at_end, outward[c], offsets[c]->at_begin);
      if (move && move->norm() <= max_move_px) corners_px[c] += *move;
    }
  }
}

}  // namespace sheen::capture
