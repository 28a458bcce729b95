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
    double shortest_px = 1e9;
    for (std::size_t s = 0; s < 4; ++s) {
      const TagSide side(camera, corners_px[s], corners_px[(s + 1) % 4], centre);
      shortest_px = std::min(shortest_px, side.length_px());
      // Two thirds of a module reach neither the code inside nor the next tag outside.
      const double module_px = (corners_px[(s + 2) % 4] - corners_px[(s + 1) % 4]).norm() / modules;
      const double half_length_px = std::clamp(0.65 * module_px, 1.5, 6.0);
      const int wanted = std::clamp(static_cast<int>(side.length_px() / 1.5), 8, kMaxPositions);
      const EdgePositions positions = measure(grey, side, half_length_px, wanted);
      outward[s] = side.outward();
      if (2 * positions.count >= wanted) offsets[s] = fit_line(positions);
    }

    // Move each corner to where its two sides meet.
    const double max_move_px = std::max(1.5, 0.6 * shortest_px / modules);
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t before = (c + 3) % 4;
      if (!offsets[before] || !offsets[c]) continue;
      Eigen::Matrix2d A;
      A << outward[before].transpose(), outward[c].transpose();
      if (std::abs(A.determinant()) < 0.1) continue;  // sides within 6 degrees of each other
      const Eigen::Vector2d move =
          A.inverse() * Eigen::Vector2d(offsets[before]->at_end, offsets[c]->at_begin);
      if (move.norm() <= max_move_px) corners_px[c] += move;
    }
  }
}

}  // namespace sheen::capture
