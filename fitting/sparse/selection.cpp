// SPDX-License-Identifier: MIT
#include "fitting/sparse/selection.h"

#include "fitting/sparse/robust_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sheen::fitting::sparse {
namespace {

/// Weight of samples at which the criterion_weight reaches half its nominal value.
constexpr float kCriterionOnset = 48.0f;
/// Numbers that naming an atom counts as. One of 304 is log 304 = 5.7 nats, a number 1/2 log n
/// = 2.2: at the price of one number, noise finds an atom that suits it too often.
constexpr std::size_t kPriceOfAtom = 3;
/// Part of the samples' weight that a model may use up as degrees of freedom.
constexpr float kMostFreedom = 0.7f;
/// Samples below which a patch is one colour.
constexpr std::size_t kFewestSamples = 4;
/// Samples from which the linear base is tried.
constexpr std::size_t kFewestForLinear = 5;
/// Forward moves without a better score before the search gives up.
constexpr int kPatience = 2;
/// Channel value from which a sample counts as saturated.
constexpr float kSaturated = 254.0f / 255.0f;
/// A censored sample never asks for more than this.
constexpr float kBrightestGuess = 1.5f;

}  // namespace

void Selection::list_candidates() {
  // Atoms that no sample touches must not divide by their ridge alone.
  constexpr float hardly_touched = 0.02f;
  AtomLine squared;
  AtomLine ridge;
  design_.measure_atoms(squared, ridge);
  design_.atom_products(&design_.colours(0), all_candidates_.correlation.data());
  for (std::size_t atom = 0; atom < design_.atom_count(); ++atom) {
    all_candidates_.remainder.atom[atom] =
        squared.atom[atom] < hardly_touched ? 0.0f : squared.atom[atom] + ridge.atom[atom];
  }
}

void Selection::follow(Candidates& candidates, std::size_t new_terms) const {
  design_.take_away(fit_.last_directions(new_terms), fit_.last_projections(new_terms),
                    candidates.remainder, candidates.correlation.data());
}

void Selection::take_out(Candidates& candidates, FunctionIdx idx) const {
  if (const auto place = design_.place_of(idx)) candidates.remainder.atom[*place] = 0.0f;
}

// Takes out the best; nothing when none is left that differs from what is there.
std::optional<Selection::Candidate> Selection::take_best(Candidates& candidates) const {
  constexpr float smallest_remainder = 1e-4f;
  const auto& [r, g, b] = candidates.correlation;
  const std::size_t count = design_.atom_count();
  const std::size_t atom = columns::best_gain(r.atom, g.atom, b.atom, candidates.remainder.atom,
                                              count, smallest_remainder);
  if (atom == count) return std::nullopt;
  const Eigen::Vector3f correlation(r.atom[atom], g.atom[atom], b.atom[atom]);
  const float remainder = std::exchange(candidates.remainder.atom[atom], 0.0f);
  return Candidate{design_.atom_at(atom), correlation.squaredNorm() / remainder};
}

float Selection::generalised_error(float squared_error, float degrees_of_freedom) const {
  const float n = design_.total_weight();
  const float left = 1.0f - degrees_of_freedom / n;
  if (!(left > 1e-3f)) return squared_error / n;  // a single direction: nothing to compare
  return squared_error / (n * left * left);
}

float Selection::score(float squared_error, float degrees_of_freedom, std::size_t terms,
                       std::size_t rbfs) const {
  const float n = design_.total_weight();
  if (terms > 1 && degrees_of_freedom > kMostFreedom * n) {
    return std::numeric_limits<float>::infinity();
  }
  const float criterion_weight = criterion_weight_ * n / (n + kCriterionOnset);
  const auto numbers = static_cast<float>(3 * terms + kPriceOfAtom * rbfs);
  const float error = generalised_error(squared_error, degrees_of_freedom);
  return 1.5f * n * std::log(error + tolerance_ * tolerance_) +
         0.5f * criterion_weight * numbers * std::log(std::max(2.0f, n));
}

float Selection::score(const StepwiseFit& fit) const {
  return score(fit.squared_error(), fit.degrees_of_freedom(), fit.terms().count,
               fit.terms().rbf_count());
}

// Whether so many further terms could lead to a better score if each lowered the error by as much
// as the next one does. Gains hardly ever grow on the way.
bool Selection::is_promising(float gain, int further_terms, float best_score) const {
  for (int more = 1; more <= further_terms; ++more) {
    const auto count = static_cast<std::size_t>(more);
    const float error = fit_.squared_error() - static_cast<float>(more) * gain / 3.0f;
    const float reached = score(std::max(0.0f, error), fit_.degrees_of_freedom(),
                                fit_.terms().count + count, fit_.terms().rbf_count() + count);
    if (reached < best_score) return true;
  }
  return false;
}

// Best prefix of the greedy path.
Selection::Scored Selection::grown(const TermList& start) {
  Candidates candidates = all_candidates_;
  fit(start);
  ++fits_;
  follow(candidates, fit_.terms().count);
  for (std::size_t i = start.base_terms(); i < start.count; ++i) {
    take_out(candidates, start.function[i]);
  }
  Scored best{fit_.terms(), score(fit_)};
  int in_vain = 0;
  while (in_vain <= kPatience && fit_.terms().rbf_count() < kMaxRbfs) {
    const auto rbf = take_best(candidates);
    if (!rbf || !is_promising(rbf->gain, kPatience + 1 - in_vain, best.score)) break;
    design_.evaluate(rbf->idx);
    if (!fit_.push(design_, rbf->idx)) continue;
    follow(candidates, 1);
    ++fits_;
    const float reached = score(fit_);
    ++in_vain;
    if (reached < best.score) {
      best = {fit_.terms(), reached};
      in_vain = 0;
    }
  }
  return best;
}

Selection::Scored Selection::pruned(Scored best) {
  while (best.terms.rbf_count() > 0) {
    fit(best.terms);
    TermList fewer = fit_.terms();
    fewer.erase(fit_.weakest_rbf());
    const float before = best.score;
    try_terms(fewer, best);
    if (!(best.score < before)) break;
  }
  return best;
}

void Selection::fit(const TermList& terms) {
  // The first of the terms that are there need not be added again.
  if (fit_is_current_ && fit_.terms().begins_with(terms)) return fit_.shorten(terms.count);
  fit_.build(design_, terms);
  fit_is_current_ = true;
}

void Selection::try_terms(const TermList& terms, Scored& best) {
  fit(terms);
  ++fits_;
  const float reached = score(fit_);
  if (reached < best.score) best = {fit_.terms(), reached};
}

TermList Selection::best_terms() {
  if (design_.rows() < kFewestSamples) return TermList::base(kConstantBase);
  list_candidates();
  const Scored constant = pruned(grown(TermList::base(kConstantBase)));
  if (design_.rows() < kFewestForLinear) return constant.terms;
  const Scored linear = pruned(grown(TermList::base(kLinearBase)));
  return linear.score < constant.score ? linear.terms : constant.terms;
}

TermList Selection::revised(const TermList& terms) {
  if (design_.rows() < kFewestForLinear) return best_terms();
  list_candidates();
  design_.evaluate(terms);
  Scored best{terms, std::numeric_limits<float>::infinity()};
  try_terms(terms, best);
  try_terms(terms.with_base(terms.base_terms() == kConstantBase ? kLinearBase : kConstantBase),
            best);
  return pruned(grown(pruned(best).terms)).terms;
}

// Judges every sample by the residual it would have had were it not in the fit: a lone outlier with
// a RBF of its own stands out, while the samples of a highlight vouch for each other. `fit_` holds
// the fit to judge by.
void Selection::judge_samples() {
  constexpr float least_left = 0.05f;
  Column leverage;
  fit_.leverages(leverage);
  for (std::size_t i = 0; i < design_.rows(); ++i) {
    const Eigen::Vector3f residual(fit_.residuals(0).row[i], fit_.residuals(1).row[i],
                                   fit_.residuals(2).row[i]);
    left_out_residual_[i] =
        size_of(residual / design_.root_weight(i)) / std::max(least_left, 1.0f - leverage.row[i]);
  }
}

// A saturated channel only says "at least this much": raises it to what is fitted. Returns whether
// anything changed.
bool Selection::censor(std::span<const DirectedColour> samples) {
  bool changed = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f& rgb = samples[i].rgb;
    if (rgb.maxCoeff() < kSaturated) continue;
    Eigen::Vector3f wanted = rgb;
    for (Eigen::Index channel = 0; channel < 3; ++channel) {
      const auto c = static_cast<std::size_t>(channel);
      const float fitted =
          (design_.colours(c).row[i] - fit_.residuals(c).row[i]) / design_.root_weight(i);
      if (rgb[channel] < kSaturated || fitted <= rgb[channel]) continue;
      wanted[channel] = std::min(fitted, kBrightestGuess);
    }
    if (wanted == rgb) continue;
    design_.set_colour(i, wanted);
    fit_is_current_ = false;
    changed = true;
  }
  return changed;
}

// Weighs down what does not fit. Returns whether anything changed. A saturated sample is judged by
// what it asked for so far.
bool Selection::discount_suspects(std::span<const DirectedColour> samples, Judgement judgement) {
  judge_samples();
  std::array<float, kMaxStoredSamples> residuals = left_out_residual_;
  const bool censored = censor(samples);
  return set_factors(samples, {residuals.data(), samples.size()}, judgement) || censored;
}

// Factors replace those of an earlier pass, so that a highlight that was mistaken for outliers can
// come back: its samples are off together, an outlier is off alone.
bool Selection::set_factors(std::span<const DirectedColour> samples,
                            std::span<const float> residuals, Judgement judgement) {
  constexpr float noticeable = 0.01f;
  constexpr float times_around = 3.0f;
  const float threshold = suspect_threshold(residuals, tolerance_ / std::sqrt(3.0f));
  std::array<float, kMaxStoredSamples> change;
  bool changed = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    float limit = threshold;
    if (judgement == Judgement::by_neighbours && residuals[i] > threshold) {
      limit = std::max(limit, times_around * residual_around(samples, residuals, i));
    }
    const float before = std::exchange(factor_[i], robust_factor(residuals[i], limit));
    changed |= std::abs(factor_[i] - before) > noticeable;
    change[i] = factor_[i] / before;
  }
  if (changed) {
    design_.reweigh({change.data(), samples.size()});
    fit_is_current_ = false;
  }
  return changed;
}

SelectedModel Selection::outcome(std::span<const DirectedColour> samples, const TermList& terms) {
  fit(terms);
  ++fits_;
  judge_samples();
  const float error =
      generalised_error(fit_.squared_error(), fit_.degrees_of_freedom()) + tolerance_ * tolerance_;
  return {fit_.model(), std::sqrt(error), fits_, {left_out_residual_.data(), samples.size()}};
}

SelectedModel Selection::choose(std::span<const DirectedColour> samples) {
  // Twice: the first pass judges by a fit that follows the outliers, the second by one that does
  // not.
  constexpr int passes = 2;
  fits_ = 0;
  design_.load(samples);
  fit_is_current_ = false;
  factor_.fill(1.0f);
  TermList terms = best_terms();
  if (design_.rows() < kFewestSamples) return outcome(samples, terms);
  for (int pass = 0; pass < passes; ++pass) {
    fit(terms);
    const Judgement judgement = pass == 0 ? Judgement::by_patch : Judgement::by_neighbours;
    if (!discount_suspects(samples, judgement)) break;
    terms = revised(terms);
  }
  return outcome(samples, terms);
}

std::optional<TermList> Selection::with_best_rbf(const TermList& terms,
                                                 const Eigen::Vector2f& seen_at) {
  if (terms.rbf_count() == kMaxRbfs) return std::nullopt;
  fit(terms);
  const std::size_t rows = design_.padded_rows();
  std::optional<FunctionIdx> best;
  float largest = 0;
  for (const std::uint16_t atom : atoms_round(seen_at)) {
    const FunctionIdx idx = kLinearBase + atom;
    if (terms.holds(idx)) continue;
    design_.evaluate(idx);
    const Column& column = design_.column(idx);
    std::array<float, 3> product;
    columns::dots(&fit_.residuals(0), 3, column, rows, product.data());
    const float squared =
        product[0] * product[0] + product[1] * product[1] + product[2] * product[2];
    const float gain = squared / (columns::dot(column, column, rows) + design_.ridge(idx));
    if (gain > largest) {
      largest = gain;
      best = idx;
    }
  }
  if (!best) return std::nullopt;
  TermList more = terms;
  more.push(*best);
  return more;
}

SelectedModel Selection::step(std::span<const DirectedColour> samples, const PatchModel& model,
                              const Eigen::Vector2f& seen_at) {
  fits_ = 0;
  design_.load(samples);
  fit_is_current_ = false;
  Scored best{TermList::of(model), std::numeric_limits<float>::infinity()};
  design_.evaluate(best.terms);
  if (design_.rows() < kFewestSamples) return outcome(samples, TermList::base(kConstantBase));
  try_terms(best.terms, best);
  // Upgrade the base.
  if (best.terms.base_terms() == kConstantBase && design_.rows() >= kFewestForLinear) {
    try_terms(best.terms.with_base(kLinearBase), best);
  }
  // Add a RBF, take one away.
  if (const auto more = with_best_rbf(best.terms, seen_at)) try_terms(*more, best);
  if (best.terms.rbf_count() > 1) {
    fit(best.terms);
    TermList fewer = fit_.terms();
    fewer.erase(fit_.weakest_rbf());
    try_terms(fewer, best);
  }
  return outcome(samples, best.terms);
}

}  // namespace sheen::fitting::sparse
