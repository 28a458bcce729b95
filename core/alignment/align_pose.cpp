// SPDX-License-Identifier: MIT
#include "core/alignment/align_pose.h"

#include "core/alignment/projection_derivative.h"
#include "core/numerics/median.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace sheen::core {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

constexpr double kSmallestSpread = 2.0 / 255;  // residuals below this are quantisation
constexpr double kHuberFactor = 1.345;         // 95 % efficiency on normal noise
constexpr int kHalvings = 3;
constexpr double kShortestStepPx = 0.005;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Pose and gain while they are being improved.
struct State {
  Eigen::Isometry3d camera_from_object;
  double gain = 1;
  Vector6d twist = Vector6d::Zero();  ///< away from the start, local coordinates
};

/// Normal equations of one step. Unknowns: turn about the centre (times the object's radius, so
/// that all are metres), shift, gain.
struct System {
  Matrix7d H = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
  Matrix6d motion = Matrix6d::Zero();  ///< mean square motion in the image of a twist, px^2
  double cost = 0;                     ///< mean Huber cost
  double weight = 0;                   ///< sum of the points' weights
  std::size_t points = 0;
};

class Aligner {
 public:
  Aligner(const ExpectedPoints& points, const CameraModel& camera, const Eigen::Isometry3d& start,
          const AlignmentLimits& limits)
      : points_(points), camera_(camera), start_(start), limits_(limits) {
    centre_in_object_.setZero();
    for (const auto& p : points.position) centre_in_object_ += p.cast<double>();
    centre_in_object_ /= static_cast<double>(points.size());
    double square = 0;
    for (const auto& p : points.position) {
      square += (p.cast<double>() - centre_in_object_).squaredNorm();
    }
    radius_m_ = std::max(std::sqrt(square / static_cast<double>(points.size())), 1e-6);
  }

  /// The start with the gain that suits it.
  [[nodiscard]] std::optional<State> first_state(const GradientImage& image) {
    State state{start_};
    const auto ratio = median_ratio(image);
    if (!ratio) return std::nullopt;
    state.gain = *ratio;
    return state;
  }

  /// Sets the width of the robust cost from the residuals at `state`.
  void set_spread(const GradientImage& image, const State& state) {
    scratch_.clear();
    for_each_residual(image, state, [&](std::size_t, double residual, const auto&, const auto&) {
      scratch_.push_back(std::abs(residual));
    });
    spread_ = scratch_.empty() ? kSmallestSpread
                               : std::max(kSmallestSpread, 1.4826 * upper_median(scratch_));
  }

  [[nodiscard]] double spread() const { return spread_; }

  /// Gauss-Newton steps, halved until the cost falls, until they are too short to matter.
  void descend(const GradientImage& image, State& state, bool gain_only = false) {
    System system = linearise(image, state);
    for (int i = 0; i < limits_.iterations; ++i) {
      const Vector7d step = solve(system, state, gain_only);
      if (!step.allFinite()) return;
      bool has_improved = false;
      double scale = 1;
      for (int halving = 0; halving < kHalvings && !has_improved; ++halving, scale /= 2) {
        const State candidate = moved(state, scale * step);
        const System there = linearise(image, candidate);
        if (there.points + there.points / 10 < system.points) continue;
        if (!(total_cost(there, candidate) < total_cost(system, state))) continue;
        state = candidate;
        system = there;
        has_improved = true;
      }
      if (!has_improved || motion_of(system, step) < kShortestStepPx) return;
    }
  }

  /// Length of the first step from the start, px: tells whether a coarser image is needed.
  [[nodiscard]] double first_step_px(const GradientImage& image, const State& state) {
    const System system = linearise(image, state);
    return motion_of(system, solve(system, state, false));
  }

  /// Robust root mean square and predicted standard deviation of the mean motion.
  [[nodiscard]] double robust_rms(const System& system) const { return std::sqrt(2 * system.cost); }
  [[nodiscard]] double uncertainty_px(const System& system) const {
    const Matrix6d H = with_prior(system).topLeftCorner<6, 6>();
    const Eigen::LDLT<Matrix6d> solver(H);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return kInfinity;
    const double variance = spread_ * spread_ / limits_.share * solver.solve(system.motion).trace();
    return variance >= 0 ? std::sqrt(variance) : kInfinity;
  }

  /// Mean distance between the points' pixels from two poses.
  [[nodiscard]] double mean_motion_px(const Eigen::Isometry3d& from,
                                      const Eigen::Isometry3d& to) const {
    double sum = 0;
    std::size_t count = 0;
    for (const auto& position : points_.position) {
      const auto a = camera_.project(from * position.cast<double>());
      const auto b = camera_.project(to * position.cast<double>());
      if (!a || !b) continue;
      sum += (*a - *b).norm();
      ++count;
    }
    return count == 0 ? kInfinity : sum / static_cast<double>(count);
  }

  [[nodiscard]] System linearise(const GradientImage& image, const State& state) const {
    System system;
    const double width = kHuberFactor * spread_;
    const Eigen::Vector3d centre = state.camera_from_object * centre_in_object_;
    for_each_residual(
        image, state,
        [&](std::size_t i, double residual, const ProjectedPoint& at, const auto& reading) {
          const Eigen::Vector3d arm =
              (state.camera_from_object * points_.position[i].cast<double>() - centre) / radius_m_;
          const auto by_twist = pixel_by_twist(at.pixel_by_point, arm);
          Vector7d J;
          J.head<6>() = by_twist.transpose() * reading.gradient;
          J[6] = -static_cast<double>(points_.luma[i]);
          const double trust = static_cast<double>(points_.weight[i]);
          const double size = std::abs(residual);
          const double robust = trust * (size <= width ? 1 : width / size);
          system.H.selfadjointView<Eigen::Lower>().rankUpdate(J, robust);
          system.g += robust * residual * J;
          system.motion += by_twist.transpose() * by_twist;
          system.cost += trust * (size <= width ? size * size / 2 : width * (size - width / 2));
          system.weight += trust;
          ++system.points;
        });
    system.H.triangularView<Eigen::StrictlyUpper>() = system.H.transpose();
    if (system.points > 0) system.motion /= static_cast<double>(system.points);
    if (system.weight > 0) system.cost /= system.weight;
    return system;
  }

 private:
  /// Calls `visit(i, residual, projection, reading)` for the points within the image.
  template <typename Visit>
  void for_each_residual(const GradientImage& image, const State& state, const Visit& visit) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto at = project_with_derivative(
          camera_, state.camera_from_object * points_.position[i].cast<double>());
      if (!at) continue;
      const auto reading = image.read(at->pixel);
      if (!reading) continue;
      visit(i, reading->value - state.gain * static_cast<double>(points_.luma[i]), *at, *reading);
    }
  }

  [[nodiscard]] std::optional<double> median_ratio(const GradientImage& image) {
    constexpr float darkest = 0.02f;
    scratch_.clear();
    const State state{start_, 0};
    for_each_residual(image, state, [&](std::size_t i, double value, const auto&, const auto&) {
      if (points_.luma[i] < darkest) return;
      scratch_.push_back(value / static_cast<double>(points_.luma[i]));
    });
    if (scratch_.size() < limits_.min_points) return std::nullopt;
    const double ratio = upper_median(scratch_);
    return ratio > 0 ? std::optional(ratio) : std::nullopt;
  }

  /// Strength of the prior in units of squared residual per px^2 of mean square motion.
  [[nodiscard]] double prior_strength() const {
    return spread_ * spread_ / limits_.share / (limits_.prior_px * limits_.prior_px);
  }

  [[nodiscard]] Matrix7d with_prior(const System& system) const {
    Matrix7d H = system.H;
    H.topLeftCorner<6, 6>() += prior_strength() * system.motion;
    return H;
  }

  [[nodiscard]] double total_cost(const System& system, const State& state) const {
    const double prior = prior_strength() / 2 * state.twist.dot(system.motion * state.twist);
    return system.weight > 0 ? system.cost + prior / system.weight : kInfinity;
  }

  [[nodiscard]] Vector7d solve(const System& system, const State& state, bool gain_only) const {
    Vector7d step = Vector7d::Zero();
    if (gain_only) {
      step[6] = -system.g[6] / system.H(6, 6);
      return step;
    }
    Vector7d g = system.g;
    g.head<6>() += prior_strength() * system.motion * state.twist;
    return with_prior(system).ldlt().solve(-g);
  }

  [[nodiscard]] State moved(const State& state, const Vector7d& step) const {
    const Eigen::Vector3d turn = step.head<3>() / radius_m_;
    const Eigen::Vector3d centre = state.camera_from_object * centre_in_object_;
    Eigen::Isometry3d twist = Eigen::Isometry3d::Identity();
    if (turn.norm() > 0) {
      twist.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    }
    twist.translation() = centre + step.segment<3>(3) - twist.linear() * centre;
    return {twist * state.camera_from_object, state.gain + step[6], state.twist + step.head<6>()};
  }

  [[nodiscard]] static double motion_of(const System& system, const Vector7d& step) {
    return std::sqrt(std::max(0.0, step.head<6>().dot(system.motion * step.head<6>())));
  }

  const ExpectedPoints& points_;
  const CameraModel& camera_;
  Eigen::Isometry3d start_;
  const AlignmentLimits& limits_;
  Eigen::Vector3d centre_in_object_;
  double radius_m_ = 1;
  double spread_ = kSmallestSpread;
  std::vector<double> scratch_;
};

}  // namespace

std::optional<Alignment> align_pose(const ExpectedPoints& points, const GradientImage& image,
                                    const CameraModel& camera,
                                    const Eigen::Isometry3d& camera_from_object,
                                    const AlignmentLimits& limits) {
  assert(points.luma.size() == points.size() && points.weight.size() == points.size());
  if (points.size() < limits.min_points) return std::nullopt;
  Aligner aligner(points, camera, camera_from_object, limits);
  auto state = aligner.first_state(image);
  if (!state) return std::nullopt;

  // Come near on a coarser image when the first step is long.
  aligner.set_spread(image, *state);
  const double first_step_px = aligner.first_step_px(image, *state);
  if (!std::isfinite(first_step_px)) return std::nullopt;
  State start = *state;
  if (first_step_px > limits.coarse_from_px) {
    const GradientImage coarse = image.smoothed(limits.coarse_smoothing_px);
    aligner.set_spread(coarse, *state);
    aligner.descend(coarse, *state);
  }

  // Settle on the fine one; the second time with the spread that remains.
  for (int round = 0; round < 2; ++round) {
    aligner.set_spread(image, *state);
    aligner.descend(image, *state);
  }

  // Believe it only if it explains the image better than the start with its own best gain.
  aligner.descend(image, start, true);
  const System before = aligner.linearise(image, start);
  const System after = aligner.linearise(image, *state);
  Alignment result{state->camera_from_object,
                   state->gain,
                   aligner.mean_motion_px(camera_from_object, state->camera_from_object),
                   aligner.uncertainty_px(after),
                   aligner.robust_rms(before),
                   aligner.robust_rms(after)};
  if (!(after.cost < before.cost) || after.points < limits.min_points) return std::nullopt;
  if (!(result.motion_px <= limits.max_motion_px)) return std::nullopt;
  if (!(result.uncertainty_px <= limits.max_uncertainty_px)) return std::nullopt;
  return result;
}

}  // namespace sheen::core
