// SPDX-License-Identifier: MIT
#include "capture/pose/edge_alignment.h"

#include "core/numerics/median.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr int kPose = 6;      // unknowns: the twist
constexpr int kGlobal = 7;    // and the swell, always the last
constexpr int kRolling = 13;  // and in between the motion during the readout

template <int N>
using Unknowns = Eigen::Matrix<double, N, 1>;

/// How an observation changes with the unknowns.
template <int N>
Unknowns<N> derivative(const EdgeObservation& seen) {
  Unknowns<N> row;
  if constexpr (N == kRolling) {
    row << seen.outward_by_twist, seen.row_share * seen.outward_by_twist, 1;
  } else {
    row << seen.outward_by_twist, 1;
  }
  return row;
}

template <int N>
double median_residual(const std::vector<EdgeObservation>& observations, const Unknowns<N>& x,
                       std::vector<double>& scratch) {
  scratch.clear();
  for (const EdgeObservation& seen : observations) {
    scratch.push_back(std::abs(seen.offset_px - derivative<N>(seen).dot(x)));
  }
  return core::upper_median(scratch);
}

/// One step of reweighted least squares with Cauchy weights.
template <int N>
std::optional<Unknowns<N>> reweighted(const std::vector<EdgeObservation>& observations,
                                      const Unknowns<N>& x, double scale_px,
                                      const ReadoutMotionPrior& prior) {
  using Matrix = Eigen::Matrix<double, N, N>;
  // Keeps the swell at zero where it cannot be told from a change of distance: a single tag.
  constexpr double swell_prior = 0.01;
  Matrix A = Matrix::Zero();
  Unknowns<N> g = Unknowns<N>::Zero();
  double weight_sum = 0;
  for (const EdgeObservation& seen : observations) {
    const Unknowns<N> row = derivative<N>(seen);
    const double r = (seen.offset_px - row.dot(x)) / scale_px;
    const double weight = 1 / (1 + r * r);
    A.noalias() += weight * row * row.transpose();
    g += weight * seen.offset_px * row;
    weight_sum += weight;
  }
  A(N - 1, N - 1) += swell_prior * weight_sum;
  if constexpr (N == kRolling) {
    A.diagonal().template segment<6>(kPose) += prior.precision;
    g.template segment<6>(kPose) += prior.precision.cwiseProduct(prior.mean);
  }
  // Radians and metres differ in size: judge the pivots on a unit diagonal.
  const Unknowns<N> scale = A.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix> ldlt(scale.asDiagonal() * A * scale.asDiagonal());
  constexpr double smallest_pivot = 1e-9;
  if (!(ldlt.vectorD().minCoeff() > smallest_pivot)) return std::nullopt;
  return Unknowns<N>(scale.cwiseProduct(ldlt.solve(scale.cwiseProduct(g))));
}

template <int N>
std::optional<EdgeAlignment> align(const std::vector<EdgeObservation>& observations,
                                   double finest_scale_px, std::vector<double>& scratch,
                                   const ReadoutMotionPrior& prior) {
  constexpr std::size_t fewest = 12;
  constexpr int rounds = 5;
  if (observations.size() < fewest) return std::nullopt;
  Unknowns<N> x = Unknowns<N>::Zero();
  for (int round = 0; round < rounds; ++round) {
    const double scale =
        std::max(finest_scale_px, 3 * median_residual<N>(observations, x, scratch));
    const auto next = reweighted<N>(observations, x, scale, prior);
    if (!next || !next->allFinite()) return std::nullopt;
    x = *next;
  }
  EdgeAlignment found;
  found.twist = x.template head<kPose>();
  if constexpr (N == kRolling) found.readout_motion = x.template segment<6>(kPose);
  found.swell_px = x[N - 1];
  x[N - 1] = 0;
  scratch.clear();
  for (const EdgeObservation& seen : observations) {
    scratch.push_back(std::abs(derivative<N>(seen).dot(x)));
  }
  found.moved_px = core::upper_median(scratch);
  return found;
}

}  // namespace

std::optional<EdgeAlignment> align_edges(const std::vector<EdgeObservation>& observations,
                                         double finest_scale_px, std::vector<double>& scratch,
                                         const std::optional<ReadoutMotionPrior>& prior) {
  return prior ? align<kRolling>(observations, finest_scale_px, scratch, *prior)
               : align<kGlobal>(observations, finest_scale_px, scratch, {});
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
