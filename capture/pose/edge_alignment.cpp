// SPDX-License-Identifier: MIT
#include "capture/pose/edge_alignment.h"

#include "core/numerics/median.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

double residual_px(const EdgeObservation& seen, const Vector7d& x) {
  return seen.offset_px - seen.outward_by_twist.dot(x.head<6>()) - x[6];
}

double median_residual(const std::vector<EdgeObservation>& observations, const Vector7d& x,
                       std::vector<double>& scratch) {
  scratch.clear();
  for (const EdgeObservation& seen : observations)
    scratch.push_back(std::abs(residual_px(seen, x)));
  return core::upper_median(scratch);
}

/// One step of reweighted least squares with Cauchy weights.
std::optional<Vector7d> reweighted(const std::vector<EdgeObservation>& observations,
                                   const Vector7d& x, double scale_px) {
  // Keeps the swell at zero where it cannot be told from a change of distance: a single tag.
  constexpr double swell_prior = 0.01;
  Matrix7d A = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
  double weight_sum = 0;
  for (const EdgeObservation& seen : observations) {
    const double r = residual_px(seen, x) / scale_px;
    const double weight = 1 / (1 + r * r);
    Vector7d row;
    row << seen.outward_by_twist, 1;
    A.noalias() += weight * row * row.transpose();
    g += weight * seen.offset_px * row;
    weight_sum += weight;
  }
  A(6, 6) += swell_prior * weight_sum;
  // Radians and metres differ in size: judge the pivots on a unit diagonal.
  const Vector7d scale = A.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix7d> ldlt(scale.asDiagonal() * A * scale.asDiagonal());
  constexpr double smallest_pivot = 1e-9;
  if (!(ldlt.vectorD().minCoeff() > smallest_pivot)) return std::nullopt;
  return Vector7d(scale.cwiseProduct(ldlt.solve(scale.cwiseProduct(g))));
}

}  // namespace

std::optional<EdgeAlignment> align_edges(const std::vector<EdgeObservation>& observations,
                                         double finest_scale_px, std::vector<double>& scratch) {
  constexpr std::size_t fewest = 12;
  constexpr int rounds = 5;
  if (observations.size() < fewest) return std::nullopt;
  Vector7d x = Vector7d::Zero();
  for (int round = 0; round < rounds; ++round) {
    const double scale = std::max(finest_scale_px, 3 * median_residual(observations, x, scratch));
    const auto next = reweighted(observations, x, scale);
    if (!next || !next->allFinite()) return std::nullopt;
    x = *next;
  }
  const Twist twist = x.head<6>();
  scratch.clear();
  for (const EdgeObservation& seen : observations) {
    scratch.push_back(std::abs(seen.outward_by_twist.dot(twist)));
  }
  return EdgeAlignment{twist, x[6], core::upper_median(scratch)};
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& camera_from_board, const Twist& twist) {
  const double angle = twist.head<3>().norm();
  const Eigen::Vector3d axis =
      angle > 0 ? Eigen::Vector3d(twist.head<3>() / angle) : Eigen::Vector3d::UnitX();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis));
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() =
      (turn * Eigen::Quaterniond(camera_from_board.linear())).normalized().toRotationMatrix();
  result.translation() = turn * camera_from_board.translation() + twist.tail<3>();
  return result;
}

}  // namespace sheen::capture
