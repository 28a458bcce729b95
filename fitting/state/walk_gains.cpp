// SPDX-License-Identifier: MIT
#include "fitting/state/walk_gains.h"

#include "core/image/srgb_curve.h"
#include "core/numerics/median.h"
#include "fitting/guidance/direction_cells.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sheen::fitting {
namespace {

constexpr std::size_t kMostOverlapPatches = 2048;
// Codes below are mostly noise, codes above may be cut off.
constexpr float kDarkest = 0.1f;
constexpr float kBrightest = 0.98f;
constexpr std::size_t kFewestShared = 50;  // cells that two walks must share

/// Of every group of walks that overlap, directly or by others, the one with the most views.
std::vector<Eigen::Index> references(const Eigen::MatrixXd& overlap,
                                     const std::vector<std::size_t>& views) {
  std::vector<Eigen::Index> by_views(views.size());
  std::iota(by_views.begin(), by_views.end(), Eigen::Index{0});
  std::ranges::stable_sort(by_views, std::ranges::greater{}, [&views](Eigen::Index walk) {
    return views[static_cast<std::size_t>(walk)];
  });
  std::vector<bool> is_reached(views.size());
  std::vector<Eigen::Index> chosen;
  for (const Eigen::Index first : by_views) {
    if (is_reached[static_cast<std::size_t>(first)]) continue;
    chosen.push_back(first);
    std::vector<Eigen::Index> open{first};
    while (!open.empty()) {
      const Eigen::Index walk = open.back();
      open.pop_back();
      if (is_reached[static_cast<std::size_t>(walk)]) continue;
      is_reached[static_cast<std::size_t>(walk)] = true;
      for (Eigen::Index other = 0; other < overlap.cols(); ++other) {
        if (overlap(walk, other) != 0) open.push_back(other);
      }
    }
  }
  return chosen;
}

}  // namespace

void multiply_light(const Gain& gain, core::SampleBatch& batch) {
  std::size_t channel = 0;
  for (auto* column : {&batch.r, &batch.g, &batch.b}) {
    const auto factor = static_cast<float>(gain.at(channel++));
    if (factor == 1) continue;
    for (float& value : *column) {
      const float light = core::linear_from_srgb(std::max(value, 0.0f));
      value = std::min(core::srgb_from_linear(factor * light), 1.0f);
    }
  }
}

WalkGains::WalkGains(std::size_t walk_count, std::size_t patch_count)
    : stride_(
          std::max<std::size_t>(1, (patch_count + kMostOverlapPatches - 1) / kMostOverlapPatches)),
      cells_each_((patch_count + stride_ - 1) / stride_ * guidance::kCellCount),
      views_(walk_count),
      cells_(walk_count * cells_each_) {}

void WalkGains::add(std::size_t walk, const core::SampleBatch& batch) {
  ++views_.at(walk);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (batch.patch[i] % stride_ != 0) continue;
    const int direction = guidance::cell_of({batch.u[i], batch.v[i]});
    Cell& cell = cells_[walk * cells_each_ + batch.patch[i] / stride_ * guidance::kCellCount +
                        static_cast<std::size_t>(direction)];
    const std::array colour{batch.r[i], batch.g[i], batch.b[i]};
    for (std::size_t c = 0; c < colour.size(); ++c) {
      if (!(colour.at(c) >= kDarkest && colour.at(c) <= kBrightest)) continue;
      cell.sum.at(c) += core::linear_from_srgb(colour.at(c));
      ++cell.count.at(c);
    }
  }
}

std::vector<double> WalkGains::log_ratios(std::size_t a, std::size_t b, std::size_t channel) const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < cells_each_; ++i) {
    const Cell& first = cells_[a * cells_each_ + i];
    const Cell& second = cells_[b * cells_each_ + i];
    if (first.count.at(channel) == 0 || second.count.at(channel) == 0) continue;
    ratios.push_back(std::log(first.mean(channel) / second.mean(channel)));
  }
  return ratios;
}

std::vector<Gain> WalkGains::estimate() const {
  std::vector<Gain> gains(views_.size(), kNoGain);
  const auto walks = static_cast<Eigen::Index>(views_.size());
  for (std::size_t channel = 0; channel < kNoGain.size(); ++channel) {
    // Least squares over pairs: log g_a - log g_b = median of what their cells say, cells' worth.
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(walks, walks);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(walks);
    for (Eigen::Index a = 0; a < walks; ++a) {
      for (Eigen::Index b = a + 1; b < walks; ++b) {
        auto ratios = log_ratios(static_cast<std::size_t>(a), static_cast<std::size_t>(b), channel);
        if (ratios.size() < kFewestShared) continue;
        const auto weight = static_cast<double>(ratios.size());
        const double ratio = core::upper_median(ratios);
        normal(a, a) += weight;
        normal(b, b) += weight;
        normal(a, b) = normal(b, a) = -weight;
        right(a) += weight * ratio;
        right(b) -= weight * ratio;
      }
    }
    const auto fixed = references(normal, views_);
    for (const Eigen::Index walk : fixed) normal(walk, walk) += 1;  // its logarithm is 0
    Eigen::VectorXd logarithm = normal.ldlt().solve(right);
    for (const Eigen::Index walk : fixed) logarithm(walk) = 0;  // but for rounding it was
    for (Eigen::Index walk = 0; walk < walks; ++walk) {
      gains[static_cast<std::size_t>(walk)].at(channel) = std::exp(logarithm(walk));
    }
  }
  return gains;
}

}  // namespace sheen::fitting
