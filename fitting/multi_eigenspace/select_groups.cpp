// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/select_groups.h"

#include "fitting/multi_eigenspace/in_steps.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Least gain that counts: below it is rounding.
constexpr double kLeastGain = 1e-9;

/// What an eigenimage or a mean costs beside a picture; it is smoother.
constexpr double kImageCost = 0.5;

/// What a residual costs beside a picture of 8 bits a value: 1/2 log2(1 + MSE) bits.
double residual_cost(double mean_square) {
  constexpr double bits = 8;
  return in_steps(0.5 * std::log2(1 + mean_square) / bits, kGainBits);
}

double overlap_gain(const ViewGroup& a, const ViewGroup& b) {
  double common = 0;
  double cost_a = 0;
  double cost_b = 0;
  for (std::size_t i = 0, j = 0; i < a.members.size() && j < b.members.size();) {
    if (a.members[i] < b.members[j]) {
      ++i;
    } else if (a.members[i] > b.members[j]) {
      ++j;
    } else {
      common += 1;
      cost_a += residual_cost(a.residuals[static_cast<Eigen::Index>(i++)]);
      cost_b += residual_cost(b.residuals[static_cast<Eigen::Index>(j++)]);
    }
  }
  return -0.5 * (common - std::max(cost_a, cost_b));
}

/// A set and what every change of it would gain.
class Choice {
 public:
  explicit Choice(const Eigen::MatrixXd& gains)
      : gains_(gains), chosen_(Eigen::VectorXd::Zero(gains.rows())) {}

  [[nodiscard]] bool has(Eigen::Index i) const { return chosen_[i] > 0; }
  /// m^T Q m changes by so much when i is added or left out.
  [[nodiscard]] double gain_of_flip(Eigen::Index i) const {
    const double others = gains_.row(i).dot(chosen_) - (has(i) ? gains_(i, i) : 0);
    const double added = gains_(i, i) + 2 * others;
    return has(i) ? -added : added;
  }
  void flip(Eigen::Index i) { chosen_[i] = 1 - chosen_[i]; }

 private:
  const Eigen::MatrixXd& gains_;
  Eigen::VectorXd chosen_;
};

/// Adds or leaves out the best one. False where nothing is gained.
bool flip_best(Choice& choice, Eigen::Index count) {
  Eigen::Index best = -1;
  double most = kLeastGain;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double gain = choice.gain_of_flip(i);
    if (gain <= most) continue;
    most = gain;
    best = i;
  }
  if (best >= 0) choice.flip(best);
  return best >= 0;
}

/// Exchanges the best pair of one that is in for one that is not. False where nothing is gained.
bool swap_best(Choice& choice, Eigen::Index count, const Eigen::MatrixXd& gains) {
  Eigen::Index best_out = -1;
  Eigen::Index best_in = -1;
  double most = kLeastGain;
  for (Eigen::Index out = 0; out < count; ++out) {
    if (!choice.has(out)) continue;
    for (Eigen::Index in = 0; in < count; ++in) {
      if (choice.has(in)) continue;
      const double gain = choice.gain_of_flip(out) + choice.gain_of_flip(in) - 2 * gains(in, out);
      if (gain <= most) continue;
      most = gain;
      best_out = out;
      best_in = in;
    }
  }
  if (best_out < 0) return false;
  choice.flip(best_out);
  choice.flip(best_in);
  return true;
}

}  // namespace

Eigen::MatrixXd description_gains(const std::vector<ViewGroup>& groups) {
  const auto count = static_cast<Eigen::Index>(groups.size());
  Eigen::MatrixXd gains(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ViewGroup& group = groups[static_cast<std::size_t>(i)];
    double cost = 0;
    for (const double residual : group.residuals) cost += residual_cost(residual);
    gains(i, i) =
        static_cast<double>(group.members.size()) - cost - kImageCost * (group.dimensions() + 1);
    for (Eigen::Index j = 0; j < i; ++j) {
      gains(i, j) = gains(j, i) = overlap_gain(group, groups[static_cast<std::size_t>(j)]);
    }
  }
  return gains;
}

std::vector<std::size_t> maximise_boolean(const Eigen::MatrixXd& gains) {
  const Eigen::Index count = gains.rows();
  Choice choice(gains);
  // Every step gains, so none is met twice.
  while (flip_best(choice, count) || swap_best(choice, count, gains)) {
  }
  std::vector<std::size_t> chosen;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (choice.has(i)) chosen.push_back(static_cast<std::size_t>(i));
  }
  return chosen;
}

}  // namespace sheen::fitting::multi_eigenspace
