// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/patch_fit.h"

#include <utility>
#include <vector>

namespace sheen::fitting::iwls {

/// The reference of the paper's section 4.1: every centre at its final radius from the start,
/// solved when all views are in. Until `solve` the model does not change.
template <std::size_t kTerms>
class Batch {
 public:
  Batch(FitSettings settings, std::size_t patch_count)
      : settings_(std::move(settings)), sums_(patch_count * settings_.layout.centers.size()) {
    const double radius = level_radius(settings_.layout.side);
    for (const Eigen::Vector2f& center : settings_.layout.centers) {
      nodes_.push_back({static_cast<double>(center.x()), static_cast<double>(center.y()), radius});
    }
  }

  FitOutcome absorb(std::size_t patch_idx, const Sample& sample, const Rgb& /*mean*/,
                    LightFieldModel& /*model*/) {
    NormalEquations<kTerms>* sums = sums_.data() + patch_idx * nodes_.size();
    for (const Node& node : nodes_) add_if_covered(node, sample, *sums++);
    return {};
  }

  FitOutcome solve(std::size_t patch_idx, const Rgb& mean, LightFieldModel& model) const {
    const NormalEquations<kTerms>* sums = sums_.data() + patch_idx * nodes_.size();
    FitOutcome outcome;
    for (std::size_t center = 0; center < nodes_.size(); ++center) {
      fit_and_store(sums[center], mean, settings_.rule, 1.0, patch_idx, center, model, outcome);
    }
    return outcome;
  }

  static constexpr bool kSolvesAtOnce = false;

 private:
  FitSettings settings_;
  std::vector<Node> nodes_;
  std::vector<NormalEquations<kTerms>> sums_;  // [patch][centre]
};

}  // namespace sheen::fitting::iwls
