// SPDX-License-Identifier: MIT
#include "fitting/sparse/stepwise_fit.h"

#include "fitting/iwls/wendland.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace sheen::fitting::sparse {
namespace {

/// Samples within this distance on the disc share one sample's weight.
constexpr float kReach = 0.1f;

/// Pull on the base's slopes and on bumps: a constant part that fades as samples arrive, and a part
/// that grows with them, because what bends a fit beyond its samples is pose and mesh error, which
/// does not average out along an arc: without it more samples make arcs worse.
struct Ridge {
  float slope = 0.02f;
  float slope_growth = 0.01f;  ///< per unit of weight
  float bump = 0.03f;
  float bump_growth = 0.01f;  ///< per unit of weight under the bump
  float onset = 96.0f;        ///< weight at which half of the growth is reached
};
constexpr Ridge kRidge;

}  // namespace

void TermList::erase(std::size_t position) {
  assert(position < count);
  std::copy(function.begin() + static_cast<std::ptrdiff_t>(position) + 1,
            function.begin() + static_cast<std::ptrdiff_t>(count),
            function.begin() + static_cast<std::ptrdiff_t>(position));
  --count;
}

TermList TermList::base(std::size_t base_terms) {
  TermList terms;
  for (FunctionIdx idx = 0; idx < base_terms; ++idx) terms.push(idx);
  return terms;
}

TermList TermList::of(const PatchModel& model) {
  TermList terms = base(model.base_terms);
  for (std::size_t i = 0; i < model.bump_count; ++i) terms.push(kLinearBase + model.atom[i]);
  return terms;
}

void Design::weigh(std::span<const DirectedColour> samples) {
  root_weight_.head(rows_).setOnes();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const float squared = (samples[i].uv - samples[j].uv).squaredNorm();
      if (squared >= kReach * kReach) continue;
      const float shared = iwls::wendland(std::sqrt(squared) / kReach);
      root_weight_[static_cast<Eigen::Index>(i)] += shared;
      root_weight_[static_cast<Eigen::Index>(j)] += shared;
    }
  }
  root_weight_.head(rows_) = root_weight_.head(rows_).cwiseSqrt().cwiseInverse();
}

void Design::set_ridge(FunctionIdx idx) {
  const float growth = total_weight_ / (total_weight_ + kRidge.onset);
  if (idx < kLinearBase) {
    ridge_[idx] = idx == 0 ? 0.0f : kRidge.slope + kRidge.slope_growth * growth * total_weight_;
  } else {
    const float covered = column(idx).dot(root_weight_.head(rows_));
    ridge_[idx] = kRidge.bump + kRidge.bump_growth * growth * covered;
  }
}

void Design::set_ridge() {
  total_weight_ = root_weight_.head(rows_).squaredNorm();
  for (FunctionIdx idx = 0; idx < kLinearBase + atoms().size(); ++idx) {
    if (evaluated_[idx]) set_ridge(idx);
  }
}

void Design::load(std::span<const DirectedColour> samples) {
  assert(!samples.empty() && samples.size() <= kMaxStoredSamples && atoms().size() <= kMaxAtoms);
  rows_ = static_cast<Eigen::Index>(samples.size());
  weigh(samples);
  // Evaluate the base at every sample.
  for (Eigen::Index row = 0; row < rows_; ++row) {
    const DirectedColour& sample = samples[static_cast<std::size_t>(row)];
    const float weight = root_weight_[row];
    positions_.row(row) = sample.uv.transpose().array();
    colours_.row(row) = weight * sample.rgb.transpose();
    const float z = std::sqrt(std::max(0.0f, 1.0f - sample.uv.squaredNorm()));
    functions_.row(row).head<4>() =
        weight * Eigen::RowVector4f(1.0f, sample.uv.x(), sample.uv.y(), z);
  }
  evaluated_.reset();
  for (FunctionIdx idx = 0; idx < kLinearBase; ++idx) evaluated_.set(idx);
  set_ridge();
}

void Design::evaluate(FunctionIdx idx) {
  if (evaluated_[idx]) return;
  evaluated_.set(idx);
  const Atom& atom = atoms()[idx - kLinearBase];
  // Wendland's function without a branch, so that it runs over several samples at a time.
  const float scale = 1.0f / (atom.support * atom.support);
  const auto u = positions_.col(0).head(rows_) - atom.center.x();
  const auto v = positions_.col(1).head(rows_) - atom.center.y();
  auto column = functions_.col(static_cast<Eigen::Index>(idx)).head(rows_).array();
  column = (scale * (u.square() + v.square())).min(1.0f).sqrt();
  column =
      root_weight_.head(rows_).array() * (1.0f - column).square().square() * (4.0f * column + 1.0f);
  set_ridge(idx);
}

void Design::evaluate(const TermList& terms) {
  for (std::size_t i = 0; i < terms.count; ++i) evaluate(terms.function[i]);
}

void Design::evaluate_all() {
  for (FunctionIdx idx = kLinearBase; idx < kLinearBase + atoms().size(); ++idx) evaluate(idx);
}

void Design::reweigh(std::span<const float> factor) {
  assert(static_cast<Eigen::Index>(factor.size()) == rows_);
  for (Eigen::Index row = 0; row < rows_; ++row) {
    const float root = std::sqrt(factor[static_cast<std::size_t>(row)]);
    if (root == 1.0f) continue;
    root_weight_[row] *= root;
    functions_.row(row) *= root;
    colours_.row(row) *= root;
  }
  set_ridge();
}

void Design::set_colour(std::size_t sample_idx, const Eigen::Vector3f& rgb) {
  const auto row = static_cast<Eigen::Index>(sample_idx);
  colours_.row(row) = root_weight_[row] * rgb.transpose();
}

void StepwiseFit::start(const Design& design) {
  rows_ = design.rows();
  terms_.count = 0;
  degrees_of_freedom_ = 0;
  residuals_.topRows(rows_) = design.colours();
}

bool StepwiseFit::push(const Design& design, FunctionIdx idx) {
  // Take away what the earlier terms explain.
  constexpr float smallest_pivot = 1e-5f;
  constexpr float smallest_norm = 1e-8f;
  assert(terms_.count < kMaxTerms);
  const auto count = static_cast<Eigen::Index>(terms_.count);
  auto direction = directions_.col(count).head(rows_);
  direction = design.column(idx);
  const float squared = direction.squaredNorm();
  if (idx >= kLinearBase && !(squared > smallest_norm)) return false;
  float pivot = squared + design.ridge(idx);
  if (count > 0) {
    auto factor_row = factor_.row(count).head(count);
    const auto earlier = directions_.topLeftCorner(rows_, count);
    factor_row.noalias() = direction.transpose() * earlier;
    direction.noalias() -= earlier * factor_row.transpose();
    const float rest = pivot - factor_row.squaredNorm();
    if (idx >= kLinearBase && !(rest > smallest_pivot * pivot)) return false;
    pivot = std::max(rest, smallest_pivot * pivot);
  }
  // Normalise and project.
  const float root = std::sqrt(pivot);
  factor_(count, count) = root;
  direction /= root;
  projections_.row(count).noalias() = direction.transpose() * design.colours();
  residuals_.topRows(rows_).noalias() -= direction * projections_.row(count);
  degrees_of_freedom_ += direction.squaredNorm();
  terms_.push(idx);
  return true;
}

void StepwiseFit::build(const Design& design, const TermList& terms) {
  start(design);
  for (std::size_t i = 0; i < terms.count; ++i) push(design, terms.function[i]);
}

float StepwiseFit::squared_error() const {
  return residuals_.topRows(rows_).squaredNorm() / 3.0f;
}

float StepwiseFit::leverage(std::size_t sample_idx) const {
  return directions_.row(static_cast<Eigen::Index>(sample_idx))
      .head(static_cast<Eigen::Index>(terms_.count))
      .squaredNorm();
}

StepwiseFit::Coefficients StepwiseFit::coefficients(Eigen::Index count) const {
  // Substitute backwards: L^T c = projections.
  Coefficients c;
  for (Eigen::Index row = count; row-- > 0;) {
    Eigen::RowVector3f sum = projections_.row(row);
    for (Eigen::Index k = row + 1; k < count; ++k) sum -= factor_(k, row) * c.row(k);
    c.row(row) = sum / factor_(row, row);
  }
  return c;
}

PatchModel StepwiseFit::model(std::size_t count) const {
  assert(count >= 1 && count <= terms_.count);
  PatchModel model;
  const Coefficients c = coefficients(static_cast<Eigen::Index>(count));
  model.base_terms = std::min(count, terms_.base_terms());
  model.bump_count = count - model.base_terms;
  for (std::size_t i = 0; i < count; ++i) {
    model.coefficient[i] = c.row(static_cast<Eigen::Index>(i));
    if (i >= model.base_terms) {
      model.atom[i - model.base_terms] =
          static_cast<std::uint16_t>(terms_.function[i] - kLinearBase);
    }
  }
  return model;
}

// Leaving out term j raises the penalised error by c_j^2 / (G^-1)_jj; the diagonal of the inverse
// is the squared norm of column j of L^-1.
std::size_t StepwiseFit::weakest_bump() const {
  const auto count = static_cast<Eigen::Index>(terms_.count);
  const Coefficients c = coefficients(count);
  Eigen::Matrix<float, kTerms, 1> inverse_column;
  std::size_t weakest = terms_.count;
  float smallest = std::numeric_limits<float>::infinity();
  for (Eigen::Index j = count; j-- > static_cast<Eigen::Index>(terms_.base_terms());) {
    float diagonal = 0;
    for (Eigen::Index row = j; row < count; ++row) {
      float sum = row == j ? 1.0f : 0.0f;
      for (Eigen::Index k = j; k < row; ++k) sum -= factor_(row, k) * inverse_column[k];
      inverse_column[row] = sum / factor_(row, row);
      diagonal += inverse_column[row] * inverse_column[row];
    }
    const float loss = c.row(j).squaredNorm() / diagonal;
    if (loss < smallest) {
      smallest = loss;
      weakest = static_cast<std::size_t>(j);
    }
  }
  assert(weakest < terms_.count);
  return weakest;
}

}  // namespace sheen::fitting::sparse
