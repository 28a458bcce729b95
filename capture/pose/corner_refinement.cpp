// SPDX-License-Identifier: MIT
#include "capture/pose/corner_refinement.h"

#include "capture/pose/edge_profile.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sheen::capture {
namespace {

constexpr int kMaxPositions = 24;

/// Measured distance of an edge from where it was expected, px, along its side.
struct EdgePositions {
  std::array<double, kMaxPositions> t{};
  std::array<double, kMaxPositions> offset_px{};
  int count = 0;
};

/// Distance of the true side from the expected one: `at_begin` at t = 0, `at_end` at t = 1.
struct SideOffset {
  double at_begin = 0;
  double at_end = 0;
};

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
    const auto slot = static_cast<std::size_t>(found.count++);
    found.t[slot] = t;
    found.offset_px[slot] = *position;
  }
  return found;
}

/// Straight line through the positions, reweighted with Cauchy weights against covered stretches.
std::optional<SideOffset> fit_line(const EdgePositions& positions) {
  constexpr int rounds = 6;
  constexpr double scale_px = 0.15;   // positions of a clean edge scatter by less
  constexpr double min_weight = 0.4;  // share of positions that must agree
  Eigen::Vector2d line = Eigen::Vector2d::Zero();
  double weight_sum = 0;
  for (int round = 0; round < rounds; ++round) {
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    weight_sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(positions.count); ++i) {
      const Eigen::Vector2d basis(1 - positions.t[i], positions.t[i]);
      const double residual = (positions.offset_px[i] - basis.dot(line)) / scale_px;
      const double weight = round == 0 ? 1 : 1 / (1 + residual * residual);
      A += weight * basis * basis.transpose();
      g += weight * positions.offset_px[i] * basis;
      weight_sum += weight;
    }
    if (!(std::abs(A.determinant()) > 1e-9)) return std::nullopt;
    line = A.inverse() * g;
  }
  if (weight_sum < min_weight * positions.count) return std::nullopt;
  return SideOffset{line[0], line[1]};
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
  const int wanted = std::clamp(static_cast<int>(side.length_px() / 1.5), 8, kMaxPositions);
  const EdgePositions positions = measure(grey, side, half_length_px, wanted);
  if (2 * positions.count < wanted) return std::nullopt;
  return fit_line(positions);
}

/// Where two sides meet, against the corner between them. No value for sides nearly parallel.
std::optional<Eigen::Vector2d> intersect(const Eigen::Vector2d& outward_before,
                                         double offset_before, const Eigen::Vector2d& outward_after,
                                         double offset_after) {
  constexpr double min_sine = 0.1;
  Eigen::Matrix2d A;
  A << outward_before.transpose(), outward_after.transpose();
  if (std::abs(A.determinant()) < min_sine) return std::nullopt;
  return Eigen::Vector2d(A.inverse() * Eigen::Vector2d(offset_before, offset_after));
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
          intersect(outward[before], offsets[before]->at_end, outward[c], offsets[c]->at_begin);
      if (move && move->norm() <= max_move_px) corners_px[c] += *move;
    }
  }
}

}  // namespace sheen::capture
