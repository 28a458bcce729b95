// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/columns.h"
#include "fitting/sparse/patch_model.h"
#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

#include <array>
#include <bitset>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace sheen::fitting::sparse {

inline constexpr std::size_t kMaxTerms = kLinearBase + kMaxRbfs;

/// Number of a function: 0 constant, 1 to 3 the direction's x, y, z, from 4 on the atoms.
using FunctionIdx = std::size_t;
inline constexpr std::size_t kMaxFunctions = kLinearBase + kMaxAtoms;

/// Functions of a patch in the order in which they were chosen; those of the base come first.
struct TermList {
  std::array<std::uint16_t, kMaxTerms> function{};
  std::size_t count = 0;

  void push(FunctionIdx idx) { function[count++] = static_cast<std::uint16_t>(idx); }
  void erase(std::size_t position);
  [[nodiscard]] bool holds(FunctionIdx idx) const;
  [[nodiscard]] bool operator==(const TermList& other) const;
  [[nodiscard]] bool begins_with(const TermList& first) const;
  [[nodiscard]] std::size_t base_terms() const {
    return count > 1 && function[1] == 1 ? kLinearBase : kConstantBase;
  }
  [[nodiscard]] std::size_t rbf_count() const { return count - base_terms(); }
  /// The same RBFs on another base.
  [[nodiscard]] TermList with_base(std::size_t base_terms) const;
  /// The base alone.
  static TermList base(std::size_t base_terms);
  /// The functions of a model.
  static TermList of(const PatchModel& model);
};

/// Samples of one patch as a weighted least-squares problem over all functions. Rows are scaled by
/// the square roots of the weights; rows behind the last sample are zero. Atoms are evaluated where
/// they are asked for: most fits need a few of them. Large: keep one per thread.
class Design {
 public:
  /// Takes 1 to kMaxStoredSamples samples. Each weighs one over the number of samples within its
  /// reach, itself included: a camera that dwells says no more than one that passes.
  void load(std::span<const DirectedColour> samples);

  /// Makes functions ready for use.
  void evaluate(FunctionIdx idx);
  void evaluate(const TermList& terms);

  /// Squared lengths and ridges of all atoms whose squared length at the samples is .02 or more,
  /// and of some others, to choose among them.
  void measure_atoms(AtomLine& squared, AtomLine& ridge);
  /// How many these are; after `measure_atoms`, as all that follows. Rounded up to whole groups of
  /// atoms; what is behind the last is zero.
  [[nodiscard]] std::size_t atom_count() const { return padded_atoms_; }
  [[nodiscard]] FunctionIdx atom_at(std::size_t place) const {
    return kLinearBase + measured_atom_[place];
  }
  /// Where an atom is among these; nothing where it is not.
  [[nodiscard]] std::optional<std::size_t> place_of(FunctionIdx atom) const;
  /// sum[c] = products of these atoms with three row-scaled columns.
  void atom_products(const Column* columns, AtomLine* sum) const;
  /// For each row-scaled column, with s the products of these atoms
  /// with it: takes s^2 from the remainder and along[c] * s from the correlations, c < 3.
  void take_away(std::span<const Column> directions, std::span<const Eigen::Vector3f> along,
                 AtomLine& remainder, AtomLine* correlation) const;

  /// Multiplies the weight of every sample, in (0, 1].
  void reweigh(std::span<const float> factor);

  /// Replaces a colour.
  void set_colour(std::size_t sample_idx, const Eigen::Vector3f& rgb);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t padded_rows() const { return padded(rows_); }
  [[nodiscard]] float total_weight() const { return total_weight_; }
  /// Pull of a function's coefficient towards zero, in units of squared function values.
  [[nodiscard]] float ridge(FunctionIdx idx) const { return ridge_[idx]; }
  [[nodiscard]] const Column& column(FunctionIdx idx) const {
    assert(evaluated_[idx]);
    return functions_[idx];
  }
  [[nodiscard]] const Column& colours(std::size_t channel) const { return colours_[channel]; }
  [[nodiscard]] float root_weight(std::size_t sample_idx) const {
    return root_weight_.row[sample_idx];
  }

 private:
  void weigh();
  void set_ridge();
  void set_ridge(FunctionIdx idx);
  [[nodiscard]] float ridge_of_atom(float covered) const;
  void list_atoms(AtomPlaces& places);

  std::size_t rows_ = 0;
  float total_weight_ = 0;
  std::unique_ptr<Column[]> functions_ = std::make_unique<Column[]>(kMaxFunctions);
  std::bitset<kMaxFunctions> evaluated_;
  std::unique_ptr<AtomLine[]> lines_ = std::make_unique<AtomLine[]>(kColumnRows);  // unweighted
  bool has_lines_ = false;
  std::array<std::uint16_t, kMaxAtoms> measured_atom_{};  // ids, ascending
  std::size_t atom_count_ = 0;
  std::size_t padded_atoms_ = 0;
  Column u_, v_;  // far outside the disc behind the last sample
  Column root_weight_;
  std::array<Column, 3> colours_;
  std::array<float, kMaxFunctions> ridge_{};
};

/// A ridge regression grown one function at a time by orthogonalisation (Chen, Cowan, Grant 1991,
/// with the ridge as additional rows): adding a function costs one pass over the samples and all
/// earlier terms, no system is solved anew.
class StepwiseFit {
 public:
  /// Starts without terms.
  void start(const Design& design);
  /// Adds a function; false (and nothing changed) when it is zero at the samples or hardly differs
  /// from what is there.
  bool push(const Design& design, FunctionIdx idx);
  /// Takes back all but the first `count` terms, at least one.
  void shorten(std::size_t count);
  /// Starts again and adds all, leaving out what `push` refuses.
  void build(const Design& design, const TermList& terms);

  [[nodiscard]] const TermList& terms() const { return terms_; }
  /// Trace of the hat matrix.
  [[nodiscard]] float degrees_of_freedom() const { return degrees_of_freedom_; }
  /// Weighted sum of squared residuals, mean over the channels.
  [[nodiscard]] float squared_error() const { return squared_error_; }
  /// Row-scaled residuals.
  [[nodiscard]] const Column& residuals(std::size_t channel) const { return residuals_[channel]; }
  /// Diagonal of the hat matrix.
  void leverages(Column& out) const;
  /// The last directions that were added, orthonormal to the others with the ridge's rows; their
  /// projections of the colours.
  [[nodiscard]] std::span<const Column> last_directions(std::size_t count) const {
    return std::span(directions_).subspan(terms_.count - count, count);
  }
  [[nodiscard]] std::span<const Eigen::Vector3f> last_projections(std::size_t count) const {
    return std::span(projections_).subspan(terms_.count - count, count);
  }
  /// The terms as a model.
  [[nodiscard]] PatchModel model() const;
  /// Position of the RBF whose loss costs the penalised fit least; there must be one.
  [[nodiscard]] std::size_t weakest_rbf() const;

 private:
  using Coefficients = std::array<Eigen::Vector3f, kMaxTerms>;
  [[nodiscard]] Coefficients coefficients() const;

  std::size_t rows_ = 0;  // padded
  TermList terms_;
  float degrees_of_freedom_ = 0;
  float squared_error_ = 0;
  std::array<Column, kMaxTerms> directions_;
  // Lower triangular: Gram matrix = L L^T.
  std::array<std::array<float, kMaxTerms>, kMaxTerms> factor_;
  std::array<Eigen::Vector3f, kMaxTerms> projections_;
  std::array<Column, 3> residuals_;
};

}  // namespace sheen::fitting::sparse
