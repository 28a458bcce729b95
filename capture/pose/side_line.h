// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>

namespace sheen::capture {

/// Measured distances of an edge from where it was expected, px outwards, along one side of a tag.
struct EdgePositions {
  static constexpr std::size_t kMost = 24;
  void add(double t, double offset_px);

  std::array<double, kMost> t;  ///< 0 at the side's beginning, 1 at its end
  std::array<double, kMost> offset_px;
  std::size_t count = 0;
};

/// Distance of the true side from the expected one, px outwards: `at_begin` at t = 0, `at_end` at
/// t = 1.
struct SideOffset {
  double at_begin = 0;
  double at_end = 0;

  [[nodiscard]] double at(double t) const { return (1 - t) * at_begin + t * at_end; }
};

/// Straight line through the positions, reweighted with Cauchy weights against covered stretches.
/// No value when the positions do not agree on one.
std::optional<SideOffset> fit_line(const EdgePositions& positions);

/// Where two sides meet, against the corner between them; the normals point outwards. No value for
/// sides nearly parallel.
std::optional<Eigen::Vector2d> meeting_point(const Eigen::Vector2d& normal_before,
                                             double offset_before_px,
                                             const Eigen::Vector2d& normal_after,
                                             double offset_after_px);

}  // namespace sheen::capture
