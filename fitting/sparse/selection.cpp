// SPDX-License-Identifier: MIT
#include "fitting/sparse/selection.h"

#include "fitting/sparse/robust_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sheen::fitting::sparse {
namespace {

/// Weight of samples at which the economy reaches half its nominal value.
constexpr float kEconomyOnset = 48.0f;
/// Numbers that naming an atom counts as. One of 304 is log 304 = 5.7 nats, a number 1/2 log n
/// = 2.2: at the price of one number, noise finds an atom that suits it too often.
constexpr std::size_t kPriceOfAtom = 3;
/// Part of the samples' weight that a model may use up as degrees of freedom.
constexpr float kMostFreedom = 0.7f;
/// Samples below which a patch is one colour.
constexpr Eigen::Index kFewestSamples = 4;
/// Samples from which the linear base is tried.
constexpr Eigen::Index kFewestForLinear = 5;
/// Forward moves without a better score before the search gives up.
constexpr int kPatience = 2;
/// Channel value from which a sample counts as saturated.
constexpr float kSaturated = 254.0f / 255.0f;
/// A censored sample never asks for more than this.
constexpr float kBrightestGuess = 1.5f;

}  // namespace

/// Every atom's worth as the next term: with d = |a|^2 + ridge less what the chosen terms explain
/// of it, and s its product with the residual, adding it lowers the penalised error by |s|^2 / d.
/// Both follow each new direction without a pass over the earlier ones.
struct Selection::Candidates {
  struct Candidate {
    FunctionIdx idx;
    float remainder;
    Eigen::RowVector3f correlation;
  };
  std::array<Candidate, kMaxAtoms> all;
  std::size_t count = 0;

  void start(Design& design) {
    // Atoms that no sample touches must not divide by their ridge alone.
    constexpr float hardly_touched = 0.02f;
    design.evaluate_all();
    count = 0;
    for (FunctionIdx idx = kLinearBase; idx < kLinearBase + atoms().size(); ++idx) {
      const auto column = design.column(idx);
      const float squared = column.squaredNorm();
      if (squared < hardly_touched) continue;
      all[count++] = {idx, squared + design.ridge(idx), column.transpose() * design.colours()};
    }
  }
  void follow(const Design& design, const StepwiseFit& fit) {
    const Eigen::RowVector3f projection = fit.last_projection();
    const auto direction = fit.last_direction();
    for (Candidate& candidate : std::span(all.data(), count)) {
      const float shared = design.column(candidate.idx).dot(direction);
      candidate.remainder -= shared * shared;
      candidate.correlation -= shared * projection;
    }
  }
  /// Takes out the best; nothing when none is left that differs from what is there.
  [[nodiscard]] std::optional<FunctionIdx> take_best() {
    constexpr float smallest_remainder = 1e-4f;
    std::size_t best = count;
    float largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(all[i].remainder > smallest_remainder)) continue;
      const float gain = all[i].correlation.squaredNorm() / all[i].remainder;
      if (gain > largest) {
        largest = gain;
        best = i;
      }
    }
    if (best == count) return std::nullopt;
    const FunctionIdx idx = all[best].idx;
    all[best] = all[--count];
    return idx;
  }
};

float Selection::generalised_error(const StepwiseFit& fit) const {
  const float n = design_.total_weight();
  const float left = 1.0f - fit.degrees_of_freedom() / n;
  if (!(left > 1e-3f)) return fit.squared_error() / n;  // a single direction: nothing to compare
  return fit.squared_error() / (n * left * left);
}

float Selection::score(const StepwiseFit& fit) const {
  const float n = design_.total_weight();
  const TermList& terms = fit.terms();
  if (terms.count > 1 && fit.degrees_of_freedom() > kMostFreedom * n) {
    return std::numeric_limits<float>::infinity();
  }
  const float economy = options_.economy * n / (n + kEconomyOnset);
  const auto numbers = static_cast<float>(3 * terms.count + kPriceOfAtom * terms.bump_count());
  return 1.5f * n * std::log(generalised_error(fit) + options_.tolerance * options_.tolerance) +
         0.5f * economy * numbers * std::log(std::max(2.0f, n));
}

// Best prefix of the greedy path.
Selection::Scored Selection::grown(std::size_t base_terms) {
  Candidates candidates;
  candidates.start(design_);
  fit_.start(design_);
  ++fits_;
  for (FunctionIdx idx = 0; idx < base_terms; ++idx) {
    fit_.push(design_, idx);
    candidates.follow(design_, fit_);
  }
  Scored best{fit_.terms(), score(fit_)};
  int in_vain = 0;
  while (in_vain <= kPatience && fit_.terms().bump_count() < kMaxBumps) {
    const auto bump = candidates.take_best();
    if (!bump) break;
    if (!fit_.push(design_, *bump)) continue;
    candidates.follow(design_, fit_);
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
  while (best.terms.bump_count() > 0) {
    fit_.build(design_, best.terms);
    TermList fewer = fit_.terms();
    fewer.erase(fit_.weakest_bump());
    const float before = best.score;
    try_terms(fewer, best);
    if (!(best.score < before)) break;
  }
  return best;
}

void Selection::try_terms(const TermList& terms, Scored& best) {
  fit_.build(design_, terms);
  ++fits_;
  const float reached = score(fit_);
  if (reached < best.score) best = {fit_.terms(), reached};
}

TermList Selection::best_terms() {
  if (design_.rows() < kFewestSamples) return TermList::base(kConstantBase);
  const Scored constant = pruned(grown(kConstantBase));
  if (design_.rows() < kFewestForLinear) return constant.terms;
  const Scored linear = pruned(grown(kLinearBase));
  return linear.score < constant.score ? linear.terms : constant.terms;
}

// Judges every sample by the residual it would have had were it not in the fit: a lone outlier with
// a bump of its own stands out, while the samples of a highlight vouch for each other. `fit_` holds
// the fit to judge by. Returns whether anything changed.
bool Selection::discount_suspects(std::span<const DirectedColour> samples) {
  std::array<float, kMaxStoredSamples> surprise;
  bool changed = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Vector3f residual = fit_.residuals().row(row) / design_.root_weight(i);
    const Eigen::Vector3f asked = design_.colours().row(row) / design_.root_weight(i);
    const float left = std::max(0.05f, 1.0f - fit_.leverage(i));
    surprise[i] = residual.norm() / left;
    // A saturated channel only says "at least this much".
    Eigen::Vector3f wanted = samples[i].rgb;
    for (int channel = 0; channel < 3; ++channel) {
      const float fitted = asked[channel] - residual[channel];
      if (wanted[channel] < kSaturated || fitted <= wanted[channel]) continue;
      wanted[channel] = std::min(fitted, kBrightestGuess);
    }
    if (wanted == samples[i].rgb) continue;
    design_.set_colour(i, wanted);
    changed = true;
  }
  const std::span<float> factors(surprise.data(), samples.size());
  return set_factors(factors) || changed;
}

// Factors replace those of an earlier pass, so that a highlight that was mistaken for an outlier
// can come back.
bool Selection::set_factors(std::span<float> factors) {
  constexpr float noticeable = 0.01f;
  robust_factors(factors, options_.tolerance);
  bool changed = false;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const float before = std::exchange(factor_[i], factors[i]);
    changed |= std::abs(factor_[i] - before) > noticeable;
    factors[i] = factor_[i] / before;
  }
  if (changed) design_.reweigh(factors);
  return changed;
}

SelectedModel Selection::outcome(const TermList& terms) {
  fit_.build(design_, terms);
  ++fits_;
  const float error = generalised_error(fit_) + options_.tolerance * options_.tolerance;
  return {fit_.model(fit_.terms().count), std::sqrt(error), fits_};
}

SelectedModel Selection::choose(std::span<const DirectedColour> samples) {
  // Twice: the first pass judges by a fit that follows the outliers, the second by one that does
  // not.
  constexpr int passes = 2;
  fits_ = 0;
  design_.load(samples);
  factor_.fill(1.0f);
  TermList terms = best_terms();
  if (design_.rows() < kFewestSamples) return outcome(terms);
  for (int pass = 0; pass < passes; ++pass) {
    fit_.build(design_, terms);
    if (!discount_suspects(samples)) break;
    terms = best_terms();
  }
  return outcome(terms);
}

std::optional<TermList> Selection::with_best_bump(const TermList& terms,
                                                  const Eigen::Vector2f& seen_at) {
  if (terms.bump_count() == kMaxBumps) return std::nullopt;
  fit_.build(design_, terms);
  const auto residuals = fit_.residuals();
  std::optional<FunctionIdx> best;
  float largest = 0;
  for (std::size_t atom = 0; atom < atoms().size(); ++atom) {
    const Atom& a = atoms()[atom];
    if ((seen_at - a.center).squaredNorm() >= a.support * a.support) continue;
    const FunctionIdx idx = kLinearBase + atom;
    const auto* end = terms.function.data() + terms.count;
    if (std::find(terms.function.data(), end, static_cast<std::uint16_t>(idx)) != end) continue;
    design_.evaluate(idx);
    const auto column = design_.column(idx);
    const float gain = (column.transpose() * residuals).squaredNorm() /
                       (column.squaredNorm() + design_.ridge(idx));
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
  Scored best{TermList::of(model), std::numeric_limits<float>::infinity()};
  design_.evaluate(best.terms);
  if (design_.rows() < kFewestSamples) return outcome(TermList::base(kConstantBase));
  try_terms(best.terms, best);
  // Upgrade the base.
  if (best.terms.base_terms() == kConstantBase && design_.rows() >= kFewestForLinear) {
    TermList linear = TermList::base(kLinearBase);
    for (std::size_t i = kConstantBase; i < best.terms.count; ++i) {
      linear.push(best.terms.function[i]);
    }
    try_terms(linear, best);
  }
  // Add a bump, take one away.
  if (const auto more = with_best_bump(best.terms, seen_at)) try_terms(*more, best);
  if (best.terms.bump_count() > 1) {
    fit_.build(design_, best.terms);
    TermList fewer = fit_.terms();
    fewer.erase(fit_.weakest_bump());
    try_terms(fewer, best);
  }
  return outcome(best.terms);
}

}  // namespace sheen::fitting::sparse
