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
  /// For each sample how far off the fit would be without it: its residual over 1 - leverage, root
  /// mean square over the channels. Valid until the next call.
  std::span<const float> left_out_residuals;
};

/// Chooses the terms of a patch: those that lower
///
///     score = 3/2 n log(GCV + tolerance^2) + criterion_weight(n) / 2 * numbers * log n,
///
/// with GCV = mean r^2 / (1 - df / n)^2, n the weight of the samples, and three numbers for a term
/// and three more for the choice of its atom. The criterion_weight grows with n to its nominal
/// value: with a dozen samples a term that is wrong costs little and one that is missing much.
/// Holds the workspace (about 350 KB): one per thread.
class Selection {
 public:
  /// The options' tolerance may be changed later.
  explicit Selection(const Options& options)
      : criterion_weight_(options.criterion_weight),
        tolerance_(options.tolerance.value_or(kToleranceOfUnknownNoise)) {}

  void set_tolerance(float tolerance) { tolerance_ = tolerance; }

  /// From nothing: forward from both bases, backward; then up to twice, with outliers weighed down
  /// (by their leave-one-out residuals) and saturated samples censored, backward and forward from
  /// there. Depends on the samples only. 1 to kMaxStoredSamples samples.
  SelectedModel choose(std::span<const DirectedColour> samples);

  /// One step from `model`, given the sample that was just seen: refit, then at most one move
  /// each: the base upgraded, the best of the RBFs round the sample added, the weakest removed.
  SelectedModel step(std::span<const DirectedColour> samples, const PatchModel& model,
                     const Eigen::Vector2f& seen_at);

 private:
  struct Scored {
    TermList terms;
    float score;
  };
  /// Every atom's worth as the next term: with d = |a|^2 + ridge less what the chosen terms explain
  /// of it, and s its product with the residual, adding it lowers the penalised error by |s|^2 / d.
  /// Both follow new directions without a pass over the earlier ones.
  struct Candidates {
    AtomLine remainder;                   ///< d; 0 for what cannot be chosen
    std::array<AtomLine, 3> correlation;  ///< s, by channel
  };

  [[nodiscard]] float generalised_error(float squared_error, float degrees_of_freedom) const;
  [[nodiscard]] float score(float squared_error, float degrees_of_freedom, std::size_t terms,
                            std::size_t rbfs) const;
  [[nodiscard]] float score(const StepwiseFit& fit) const;
  void list_candidates();
  void follow(Candidates& candidates, std::size_t new_terms) const;
  void take_out(Candidates& candidates, FunctionIdx idx) const;
  /// An atom and by how much it lowers the penalised error.
  struct Candidate {
    FunctionIdx idx;
    float gain;
  };
  [[nodiscard]] std::optional<Candidate> take_best(Candidates& candidates) const;
  [[nodiscard]] bool is_promising(float gain, int further_terms, float best_score) const;
  [[nodiscard]] Scored grown(const TermList& start);
  [[nodiscard]] Scored pruned(Scored start);
  [[nodiscard]] TermList best_terms();
  [[nodiscard]] TermList revised(const TermList& terms);
  /// What a sample's residual is compared with.
  enum class Judgement { by_patch, by_neighbours };
  [[nodiscard]] bool discount_suspects(std::span<const DirectedColour> samples,
                                       Judgement judgement);
  [[nodiscard]] bool censor(std::span<const DirectedColour> samples);
  void judge_samples();
  [[nodiscard]] bool set_factors(std::span<const DirectedColour> samples,
                                 std::span<const float> residuals, Judgement judgement);
  [[nodiscard]] std::optional<TermList> with_best_rbf(const TermList& terms,
                                                      const Eigen::Vector2f& seen_at);
  void fit(const TermList& terms);
  void try_terms(const TermList& terms, Scored& best);
  [[nodiscard]] SelectedModel outcome(std::span<const DirectedColour> samples,
                                      const TermList& terms);

  float criterion_weight_;
  float tolerance_;
  Design design_;
  StepwiseFit fit_;
  bool fit_is_current_ = false;                    ///< `fit_` is of `design_` as it is now
  Candidates all_candidates_;                      ///< as long as there are no terms
  std::array<float, kMaxStoredSamples> factor_{};  ///< what weights are multiplied by
  std::array<float, kMaxStoredSamples> left_out_residual_{};
  std::size_t fits_ = 0;
};

}  // namespace sheen::fitting::sparse
