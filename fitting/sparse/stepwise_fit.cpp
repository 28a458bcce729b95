// SPDX-License-Identifier: MIT
#include "fitting/sparse/stepwise_fit.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace sheen::fitting::sparse {
namespace {

/// Samples within this distance on the disc share one sample's weight.
constexpr float kReach = 0.1f;

/// Pull on the base's slopes and on RBFs: a constant part that fades as samples arrive, and a part
/// that grows with them, because what bends a fit beyond its samples is pose and mesh error, which
/// does not average out along an arc: without it more samples make arcs worse.
struct Ridge {
  float slope = 0.02f;
  float slope_growth = 0.01f;  ///< per unit of weight
  float rbf = 0.03f;
  float rbf_growth = 0.01f;  ///< per unit of weight under the RBF
  float onset = 96.0f;       ///< weight at which half of the growth is reached
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

bool TermList::holds(FunctionIdx idx) const {
  const auto* end = function.data() + count;
  return std::find(function.data(), end, static_cast<std::uint16_t>(idx)) != end;
}

bool TermList::operator==(const TermList& other) const {
  return std::equal(function.data(), function.data() + count, other.function.data(),
                    other.function.data() + other.count);
}

bool TermList::begins_with(const TermList& first) const {
  return first.count <= count &&
         std::equal(first.function.data(), first.function.data() + first.count, function.data());
}

TermList TermList::with_base(std::size_t base_terms_wanted) const {
  TermList terms = base(base_terms_wanted);
  for (std::size_t i = base_terms(); i < count; ++i) terms.push(function[i]);
  return terms;
}

TermList TermList::base(std::size_t base_terms) {
  TermList terms;
  for (FunctionIdx idx = 0; idx < base_terms; ++idx) terms.push(idx);
  return terms;
}

TermList TermList::of(const PatchModel& model) {
  TermList terms = base(model.base_terms);
  for (std::size_t i = 0; i < model.rbf_count; ++i) terms.push(kLinearBase + model.atom[i]);
  return terms;
}

void Design::weigh() {
  columns::kernel_density(u_, v_, padded_rows(), kReach, root_weight_);
  for (std::size_t row = 0; row < rows_; ++row) {
    root_weight_.row[row] = 1.0f / std::sqrt(root_weight_.row[row]);
  }
  std::fill(root_weight_.row + rows_, root_weight_.row + padded_rows(), 0.0f);
}

void Design::set_ridge(FunctionIdx idx) {
  const float growth = total_weight_ / (total_weight_ + kRidge.onset);
  if (idx < kLinearBase) {
    ridge_[idx] = idx == 0 ? 0.0f : kRidge.slope + kRidge.slope_growth * growth * total_weight_;
  } else {
    ridge_[idx] = ridge_of_atom(columns::dot(functions_[idx], root_weight_, padded_rows()));
  }
}

/// `covered`: weight under the atom.
float Design::ridge_of_atom(float covered) const {
  const float growth = total_weight_ / (total_weight_ + kRidge.onset);
  return kRidge.rbf + kRidge.rbf_growth * growth * covered;
}

void Design::set_ridge() {
  total_weight_ = columns::dot(root_weight_, root_weight_, padded_rows());
  const std::size_t count = kLinearBase + atoms().size();
  for (FunctionIdx idx = 0; idx < count; ++idx) {
    if (evaluated_[idx]) set_ridge(idx);
  }
}

void Design::load(std::span<const DirectedColour> samples) {
  constexpr float far_outside = 8.0f;
  assert(!samples.empty() && samples.size() <= kMaxStoredSamples && atoms().size() <= kMaxAtoms);
  rows_ = samples.size();
  for (std::size_t row = 0; row < rows_; ++row) {
    u_.row[row] = samples[row].uv.x();
    v_.row[row] = samples[row].uv.y();
  }
  std::fill(u_.row + rows_, u_.row + padded_rows(), far_outside);
  std::fill(v_.row + rows_, v_.row + padded_rows(), far_outside);
  weigh();
  // Evaluate the base at every sample.
  for (std::size_t row = 0; row < padded_rows(); ++row) {
    const float weight = root_weight_.row[row];
    const Eigen::Vector3f rgb = row < rows_ ? samples[row].rgb : Eigen::Vector3f::Zero();
    for (std::size_t channel = 0; channel < 3; ++channel) {
      colours_[channel].row[row] = weight * rgb[static_cast<Eigen::Index>(channel)];
    }
    const float u = u_.row[row];
    const float v = v_.row[row];
    functions_[0].row[row] = weight;
    functions_[1].row[row] = weight * u;
    functions_[2].row[row] = weight * v;
    functions_[3].row[row] = weight * std::sqrt(std::max(0.0f, 1.0f - u * u - v * v));
  }
  has_lines_ = false;
  evaluated_.reset();
  total_weight_ = columns::dot(root_weight_, root_weight_, padded_rows());
  for (FunctionIdx idx = 0; idx < kLinearBase; ++idx) {
    evaluated_.set(idx);
    set_ridge(idx);
  }
}

void Design::evaluate(FunctionIdx idx) {
  if (evaluated_[idx]) return;
  evaluated_.set(idx);
  const Atom& atom = atoms()[idx - kLinearBase];
  columns::wendland(u_, v_, root_weight_, padded_rows(), atom.center.x(), atom.center.y(),
                    atom.support, functions_[idx]);
  set_ridge(idx);
}

void Design::evaluate(const TermList& terms) {
  for (std::size_t i = 0; i < terms.count; ++i) evaluate(terms.function[i]);
}

// No weight is above 1: a squared length of .02 needs a sample where the RBF is .0125 or more.
void Design::list_atoms(AtomPlaces& places) {
  constexpr float far_outside = 8.0f;
  AtomSet felt{};
  for (std::size_t row = 0; row < rows_; ++row) {
    const AtomSet& here = atoms_felt_at({u_.row[row], v_.row[row]});
    for (std::size_t word = 0; word < felt.size(); ++word) felt[word] |= here[word];
  }
  std::size_t count = 0;
  for (std::size_t word = 0; word < felt.size(); ++word) {
    for (std::uint64_t left = felt[word]; left != 0; left &= left - 1) {
      const std::size_t id = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
      const Atom& atom = atoms()[id];
      measured_atom_[count] = static_cast<std::uint16_t>(id);
      places.center_u.atom[count] = atom.center.x();
      places.center_v.atom[count] = atom.center.y();
      places.per_squared_support.atom[count] = 1.0f / (atom.support * atom.support);
      ++count;
    }
  }
  atom_count_ = count;
  padded_atoms_ = (count + kAtomGroup - 1) / kAtomGroup * kAtomGroup;
  for (; count < padded_atoms_; ++count) {
    places.center_u.atom[count] = places.center_v.atom[count] = far_outside;
    places.per_squared_support.atom[count] = 1.0f;
  }
}

std::optional<std::size_t> Design::place_of(FunctionIdx atom) const {
  const auto end = measured_atom_.begin() + static_cast<std::ptrdiff_t>(atom_count_);
  const auto id = static_cast<std::uint16_t>(atom - kLinearBase);
  const auto found = std::lower_bound(measured_atom_.begin(), end, id);
  if (found == end || *found != id) return std::nullopt;
  return static_cast<std::size_t>(found - measured_atom_.begin());
}

void Design::measure_atoms(AtomLine& squared, AtomLine& ridge) {
  if (!has_lines_) {
    AtomPlaces places;
    list_atoms(places);
    columns::atom_lines(u_, v_, rows_, places, padded_atoms_, lines_.get());
    has_lines_ = true;
  }
  Column squared_weight;
  for (std::size_t row = 0; row < rows_; ++row) {
    squared_weight.row[row] = root_weight_.row[row] * root_weight_.row[row];
  }
  columns::atom_squares(lines_.get(), rows_, padded_atoms_, squared_weight, ridge, squared);
  for (std::size_t k = 0; k < padded_atoms_; ++k) ridge.atom[k] = ridge_of_atom(ridge.atom[k]);
}

void Design::atom_products(const Column* of, AtomLine* sum) const {
  std::array<Column, 3> factor;
  for (std::size_t c = 0; c < factor.size(); ++c) {
    for (std::size_t row = 0; row < rows_; ++row) {
      factor[c].row[row] = root_weight_.row[row] * of[c].row[row];
    }
  }
  columns::atom_sums(lines_.get(), rows_, padded_atoms_, factor.data(), sum);
}

void Design::take_away(std::span<const Column> directions, std::span<const Eigen::Vector3f> along,
                       AtomLine& remainder, AtomLine* correlation) const {
  constexpr std::size_t at_once = 4;
  std::array<Column, at_once> factor;
  for (std::size_t first = 0; first < directions.size(); first += at_once) {
    const std::size_t count = std::min(at_once, directions.size() - first);
    for (std::size_t j = 0; j < count; ++j) {
      const Column& direction = directions[first + j];
      for (std::size_t row = 0; row < rows_; ++row) {
        factor[j].row[row] = root_weight_.row[row] * direction.row[row];
      }
    }
    columns::take_away(lines_.get(), rows_, padded_atoms_, factor.data(), along[first].data(),
                       count, remainder, correlation);
  }
}

void Design::reweigh(std::span<const float> factor) {
  assert(factor.size() == rows_);
  Column root{};
  for (std::size_t row = 0; row < rows_; ++row) root.row[row] = std::sqrt(factor[row]);
  columns::scale(root, padded_rows(), root_weight_);
  for (Column& channel : colours_) columns::scale(root, padded_rows(), channel);
  const std::size_t count = kLinearBase + atoms().size();
  for (FunctionIdx idx = 0; idx < count; ++idx) {
    if (evaluated_[idx]) columns::scale(root, padded_rows(), functions_[idx]);
  }
  set_ridge();
}

void Design::set_colour(std::size_t sample_idx, const Eigen::Vector3f& rgb) {
  for (std::size_t channel = 0; channel < 3; ++channel) {
    colours_[channel].row[sample_idx] =
        root_weight_.row[sample_idx] * rgb[static_cast<Eigen::Index>(channel)];
  }
}

void StepwiseFit::start(const Design& design) {
  rows_ = design.padded_rows();
  terms_.count = 0;
  degrees_of_freedom_ = 0;
  squared_error_ = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::copy_n(design.colours(channel).row, rows_, residuals_[channel].row);
    squared_error_ += columns::dot(residuals_[channel], residuals_[channel], rows_) / 3.0f;
  }
}

bool StepwiseFit::push(const Design& design, FunctionIdx idx) {
  // Take away what the earlier terms explain.
  constexpr float smallest_pivot = 1e-5f;
  constexpr float smallest_norm = 1e-8f;
  assert(terms_.count < kMaxTerms);
  const std::size_t count = terms_.count;
  Column& direction = directions_[count];
  std::copy_n(design.column(idx).row, rows_, direction.row);
  const float squared = columns::dot(direction, direction, rows_);
  if (idx >= kLinearBase && !(squared > smallest_norm)) return false;
  float pivot = squared + design.ridge(idx);
  if (count > 0) {
    float* factor_row = factor_[count].data();
    columns::dots(directions_.data(), count, direction, rows_, factor_row);
    columns::subtract(directions_.data(), count, factor_row, rows_, direction);
    float rest = pivot;
    for (std::size_t k = 0; k < count; ++k) rest -= factor_row[k] * factor_row[k];
    if (idx >= kLinearBase && !(rest > smallest_pivot * pivot)) return false;
    pivot = std::max(rest, smallest_pivot * pivot);
  }
  // Normalise and project.
  const float root = std::sqrt(pivot);
  factor_[count][count] = root;
  const float per_root = 1.0f / root;
  for (std::size_t row = 0; row < rows_; ++row) direction.row[row] *= per_root;
  Eigen::Vector3f& projection = projections_[count];
  squared_error_ = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    float& along = projection[static_cast<Eigen::Index>(channel)];
    along = columns::dot(direction, design.colours(channel), rows_);
    columns::subtract(&direction, 1, &along, rows_, residuals_[channel]);
    squared_error_ += columns::dot(residuals_[channel], residuals_[channel], rows_) / 3.0f;
  }
  degrees_of_freedom_ += columns::dot(direction, direction, rows_);
  terms_.push(idx);
  return true;
}

void StepwiseFit::shorten(std::size_t count) {
  assert(count >= 1);
  if (count >= terms_.count) return;
  for (std::size_t k = count; k < terms_.count; ++k) {
    degrees_of_freedom_ -= columns::dot(directions_[k], directions_[k], rows_);
  }
  squared_error_ = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::array<float, kMaxTerms> back;
    for (std::size_t k = count; k < terms_.count; ++k) {
      back[k] = -projections_[k][static_cast<Eigen::Index>(channel)];
    }
    columns::subtract(&directions_[count], terms_.count - count, &back[count], rows_,
                      residuals_[channel]);
    squared_error_ += columns::dot(residuals_[channel], residuals_[channel], rows_) / 3.0f;
  }
  terms_.count = count;
}

void StepwiseFit::build(const Design& design, const TermList& terms) {
  start(design);
  for (std::size_t i = 0; i < terms.count; ++i) push(design, terms.function[i]);
}

void StepwiseFit::leverages(Column& out) const {
  columns::squared_lengths(directions_.data(), terms_.count, rows_, out);
}

StepwiseFit::Coefficients StepwiseFit::coefficients() const {
  // Substitute backwards: L^T c = projections.
  Coefficients c;
  for (std::size_t row = terms_.count; row-- > 0;) {
    Eigen::Vector3f sum = projections_[row];
    for (std::size_t k = row + 1; k < terms_.count; ++k) sum -= factor_[k][row] * c[k];
    c[row] = sum / factor_[row][row];
  }
  return c;
}

PatchModel StepwiseFit::model() const {
  assert(terms_.count >= 1);
  PatchModel model;
  const Coefficients c = coefficients();
  model.base_terms = terms_.base_terms();
  model.rbf_count = terms_.rbf_count();
  for (std::size_t i = 0; i < terms_.count; ++i) {
    model.coefficient[i] = c[i];
    if (i >= model.base_terms) {
      model.atom[i - model.base_terms] =
          static_cast<std::uint16_t>(terms_.function[i] - kLinearBase);
    }
  }
  return model;
}

// Leaving out term j raises the penalised error by c_j^2 / (G^-1)_jj; the diagonal of the inverse
// is the squared norm of column j of L^-1.
std::size_t StepwiseFit::weakest_rbf() const {
  const std::size_t count = terms_.count;
  const Coefficients c = coefficients();
  std::array<float, kMaxTerms> inverse_column;
  std::size_t weakest = count;
  float smallest = std::numeric_limits<float>::infinity();
  for (std::size_t j = count; j-- > terms_.base_terms();) {
    float diagonal = 0;
    for (std::size_t row = j; row < count; ++row) {
      float sum = row == j ? 1.0f : 0.0f;
      for (std::size_t k = j; k < row; ++k) sum -= factor_[row][k] * inverse_column[k];
      inverse_column[row] = sum / factor_[row][row];
      diagonal += inverse_column[row] * inverse_column[row];
    }
    const float loss = c[j].squaredNorm() / diagonal;
    if (loss < smallest) {
      smallest = loss;
      weakest = j;
    }
  }
  assert(weakest < count);
  return weakest;
}

}  // namespace sheen::fitting::sparse
