// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/options.h"
#include "fitting/sparse/stepwise_fit.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace sheen::fitting::sparse {

/// A patch and how far off its predictions are to be expected.
struct SelectedModel {
  PatchModel model;
  /// Root mean squared error of a new sample by generalised cross-validation, never below the
  /// tolerance.
  float expected_error = 0;
  std::size_t fits = 0;  ///< regressions solved on the way
};

/// Chooses the terms of a patch: those that lower
///
///     score = 3/2 n log(GCV + tolerance^2) + economy(n) / 2 * numbers * log n,
///
/// with GCV = mean r^2 / (1 - df / n)^2, n the weight of the samples, and three numbers for a term
/// and three more for the choice of its atom. The economy grows with n to its nominal value: with a
/// dozen samples a term that is wrong costs little and one that is missing much. Holds the
/// workspace (about 180 KB): one per thread.
class Selection {
 public:
  explicit Selection(const Options& options) : options_(options) {}

  /// From nothing: forward from both bases, backward, then up to twice more with outliers weighed
  /// down (by their leave-one-out residuals) and saturated samples censored. Depends on
  /// the samples only. 1 to kMaxStoredSamples samples.
  SelectedModel choose(std::span<const DirectedColour> samples);

  /// One step from `model`, given the sample that was just seen: refit, then at most one move
  /// each: the base upgraded, the best bump that reaches the sample added, the weakest removed.
  SelectedModel step(std::span<const DirectedColour> samples, const PatchModel& model,
                     const Eigen::Vector2f& seen_at);

 private:
  struct Scored {
    TermList terms;
    float score;
  };
  struct Candidates;

  [[nodiscard]] float generalised_error(const StepwiseFit& fit) const;
  [[nodiscard]] float score(const StepwiseFit& fit) const;
  [[nodiscard]] Scored grown(std::size_t base_terms);
  [[nodiscard]] Scored pruned(Scored start);
  [[nodiscard]] TermList best_terms();
  [[nodiscard]] bool discount_suspects(std::span<const DirectedColour> samples);
  [[nodiscard]] bool set_factors(std::span<float> factors);
  [[nodiscard]] std::optional<TermList> with_best_bump(const TermList& terms,
                                                       const Eigen::Vector2f& seen_at);
  void try_terms(const TermList& terms, Scored& best);
  [[nodiscard]] SelectedModel outcome(const TermList& terms);

  Options options_;
  Design design_;
  StepwiseFit fit_;
  std::array<float, kMaxStoredSamples> factor_{};  ///< what weights are multiplied by
  std::size_t fits_ = 0;
};

}  // namespace sheen::fitting::sparse
