// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/patch_fit.h"

#include <numbers>
#include <utility>
#include <vector>

namespace sheen::fitting::iwls {

/// The paper's adaptive construction (section 3.3.1): every centre starts with the largest support
/// and shrinks it by a quarter while it holds too many samples (eq. 10).
///
/// No sample is stored. Radii only shrink, and only through a fixed family, so the list that the
/// paper would keep - all samples ever seen within the current radius - has exactly the sums that
/// were running at that radius from the start. The current radius is the largest whose count is
/// within the limit, a function of the counts: nothing depends on the order of the views.
template <std::size_t kTerms>
class Adaptive {
 public:
  Adaptive(FitSettings settings, std::size_t patch_count);

  FitOutcome integrate(std::size_t patch_idx, const Sample& sample, const Rgb& mean,
                       LightFieldModel& model);
  FitOutcome solve(std::size_t patch_idx, const Rgb& mean, LightFieldModel& model) const;

  static constexpr bool kSolvesAtOnce = true;

  /// Radii a centre may have, falling.
  [[nodiscard]] const std::vector<double>& radii() const { return radii_; }
  /// Index into `radii` of a centre's current radius.
  [[nodiscard]] std::size_t radius_idx(std::size_t patch_idx, std::size_t center_idx) const {
    return current_radius(sums_of(patch_idx, center_idx));
  }
  /// Running sums of a centre, one per radius; those at radii larger than the current one have
  /// stopped.
  [[nodiscard]] const NormalEquations<kTerms>* sums_of(std::size_t patch_idx,
                                                       std::size_t center_idx) const {
    return sums_.data() +
           (patch_idx * settings_.layout.centers.size() + center_idx) * radii_.size();
  }

 private:
  [[nodiscard]] std::size_t current_radius(const NormalEquations<kTerms>* sums) const;
  bool add(const Eigen::Vector2f& center, const Sample& sample,
           NormalEquations<kTerms>* sums) const;
  void refit(std::size_t patch_idx, std::size_t center_idx, const Rgb& mean, LightFieldModel& model,
             FitOutcome& outcome) const;

  FitSettings settings_;
  std::vector<double> radii_;
  std::vector<NormalEquations<kTerms>> sums_;  // [patch][centre][radius]
};

template <std::size_t kTerms>
Adaptive<kTerms>::Adaptive(FitSettings settings, std::size_t patch_count)
    : settings_(std::move(settings)) {
  // Below spacing / sqrt 2 the discs of four neighbouring centres no longer meet and leave a hole.
  const double floor = spacing(settings_.layout.side) / std::numbers::sqrt2;
  for (double radius = kRootRadius; radius >= floor; radius *= 0.75) radii_.push_back(radius);
  sums_.resize(patch_count * settings_.layout.centers.size() * radii_.size());
}

template <std::size_t kTerms>
std::size_t Adaptive<kTerms>::current_radius(const NormalEquations<kTerms>* sums) const {
  std::size_t k = 0;
  while (k + 1 < radii_.size() && sums[k].count > settings_.refine_above &&
         sums[k + 1].count >= static_cast<double>(kTerms)) {
    ++k;
  }
  return k;
}

// Adds the sample at the current radius and all smaller ones. Returns whether the current list took
// it.
template <std::size_t kTerms>
bool Adaptive<kTerms>::add(const Eigen::Vector2f& center, const Sample& sample,
                           NormalEquations<kTerms>* sums) const {
  const std::size_t current = current_radius(sums);
  for (std::size_t k = current; k < radii_.size(); ++k) {
    const Node node{static_cast<double>(center.x()), static_cast<double>(center.y()), radii_[k]};
    if (!add_if_covered(node, sample, sums[k])) return k > current;
  }
  return true;
}

template <std::size_t kTerms>
void Adaptive<kTerms>::refit(std::size_t patch_idx, std::size_t center_idx, const Rgb& mean,
                             LightFieldModel& model, FitOutcome& outcome) const {
  const NormalEquations<kTerms>* sums = sums_of(patch_idx, center_idx);
  const std::size_t k = current_radius(sums);
  // The partition of unity uses one radius everywhere: express the fit in its units.
  const double scale = level_radius(settings_.layout.side) / radii_[k];
  fit_and_store(sums[k], mean, settings_.rule, scale, patch_idx, center_idx, model, outcome);
}

template <std::size_t kTerms>
FitOutcome Adaptive<kTerms>::integrate(std::size_t patch_idx, const Sample& sample, const Rgb& mean,
                                       LightFieldModel& model) {
  const std::size_t centers = settings_.layout.centers.size();
  NormalEquations<kTerms>* sums = sums_.data() + patch_idx * centers * radii_.size();
  FitOutcome outcome;
  for (std::size_t center = 0; center < centers; ++center, sums += radii_.size()) {
    const bool taken = add(settings_.layout.centers[center], sample, sums);
    // Centres without samples follow the patch's mean.
    const bool empty = sums[current_radius(sums)].count == 0;
    if (taken || empty) refit(patch_idx, center, mean, model, outcome);
  }
  return outcome;
}

template <std::size_t kTerms>
FitOutcome Adaptive<kTerms>::solve(std::size_t patch_idx, const Rgb& mean,
                                   LightFieldModel& model) const {
  FitOutcome outcome;
  for (std::size_t center = 0; center < settings_.layout.centers.size(); ++center) {
    refit(patch_idx, center, mean, model, outcome);
  }
  return outcome;
}

}  // namespace sheen::fitting::iwls
