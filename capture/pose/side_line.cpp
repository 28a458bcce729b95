// SPDX-License-Identifier: MIT
#include "capture/pose/side_line.h"

#include <Eigen/LU>

#include <cassert>
#include <cmath>

namespace sheen::capture {

void EdgePositions::add(double at, double px) {
  assert(count < kMost);
  t[count] = at;
  offset_px[count] = px;
  ++count;
}

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
    for (std::size_t i = 0; i < positions.count; ++i) {
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
  if (weight_sum < min_weight * static_cast<double>(positions.count)) return std::nullopt;
  return SideOffset{line[0], line[1]};
}

std::optional<Eigen::Vector2d> meeting_point(const Eigen::Vector2d& normal_before,
                                             double offset_before_px,
                                             const Eigen::Vector2d& normal_after,
                                             double offset_after_px) {
  constexpr double min_sine = 0.1;
  Eigen::Matrix2d A;
  A << normal_before.transpose(), normal_after.transpose();
  if (std::abs(A.determinant()) < min_sine) return std::nullopt;
  return Eigen::Vector2d(A.inverse() * Eigen::Vector2d(offset_before_px, offset_after_px));
}

}  // namespace sheen::capture
