// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/patch_model.h"
#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

#include <array>
#include <bitset>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sheen::fitting::sparse {

inline constexpr std::size_t kMaxTerms = kLinearBase + kMaxBumps;

/// Number of a function: 0 constant, 1 to 3 the direction's x, y, z, from 4 on the atoms.
using FunctionIdx = std::size_t;
inline constexpr std::size_t kMaxFunctions = kLinearBase + kMaxAtoms;

/// Functions of a patch in the order in which they were chosen; those of the base come first.
struct TermList {
  std::array<std::uint16_t, kMaxTerms> function{};
  std::size_t count = 0;

  void push(FunctionIdx idx) { function[count++] = static_cast<std::uint16_t>(idx); }
  void erase(std::size_t position);
  [[nodiscard]] std::size_t base_terms() const {
    return count > 1 && function[1] == 1 ? kLinearBase : kConstantBase;
  }
  [[nodiscard]] std::size_t bump_count() const { return count - base_terms(); }
  /// The base alone.
  static TermList base(std::size_t base_terms);
  /// The functions of a model.
  static TermList of(const PatchModel& model);
};

/// Samples of one patch as a weighted least-squares problem over all functions. Rows are scaled by
/// the square roots of the weights. Atoms are evaluated where they are asked for: most fits need a
/// few of them. Large: keep one per thread.
class Design {
 public:
  /// Takes 1 to kMaxStoredSamples samples. Each weighs one over the number of samples within its
  /// reach, itself included: a camera that dwells says no more than one that passes.
  void load(std::span<const DirectedColour> samples);

  /// Makes functions ready for use.
  void evaluate(FunctionIdx idx);
  void evaluate(const TermList& terms);
  void evaluate_all();

  /// Multiplies the weight of every sample, in (0, 1].
  void reweigh(std::span<const float> factor);

  /// Replaces a colour.
  void set_colour(std::size_t sample_idx, const Eigen::Vector3f& rgb);

  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  [[nodiscard]] float total_weight() const { return total_weight_; }
  /// Pull of a function's coefficient towards zero, in units of squared function values.
  [[nodiscard]] float ridge(FunctionIdx idx) const { return ridge_[idx]; }
  [[nodiscard]] auto column(FunctionIdx idx) const {
    assert(evaluated_[idx]);
    return functions_.col(static_cast<Eigen::Index>(idx)).head(rows_);
  }
  [[nodiscard]] auto colours() const { return colours_.topRows(rows_); }
  [[nodiscard]] float root_weight(std::size_t sample_idx) const {
    return root_weight_[static_cast<Eigen::Index>(sample_idx)];
  }

 private:
  void weigh(std::span<const DirectedColour> samples);
  void set_ridge();
  void set_ridge(FunctionIdx idx);

  static constexpr int kRows = static_cast<int>(kMaxStoredSamples);
  Eigen::Index rows_ = 0;
  float total_weight_ = 0;
  // On the heap: 160 KB are more than Eigen lets lie in an object.
  Eigen::MatrixXf functions_ = Eigen::MatrixXf::Zero(kRows, static_cast<int>(kMaxFunctions));
  std::bitset<kMaxFunctions> evaluated_;
  Eigen::Array<float, kRows, 2> positions_;
  Eigen::Matrix<float, kRows, 3> colours_;
  Eigen::Matrix<float, kRows, 1> root_weight_;
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
  /// Starts again and adds all, leaving out what `push` refuses.
  void build(const Design& design, const TermList& terms);

  [[nodiscard]] const TermList& terms() const { return terms_; }
  /// Trace of the hat matrix.
  [[nodiscard]] float degrees_of_freedom() const { return degrees_of_freedom_; }
  /// Weighted sum of squared residuals, mean over the channels.
  [[nodiscard]] float squared_error() const;
  /// Row-scaled residuals.
  [[nodiscard]] auto residuals() const { return residuals_.topRows(rows_); }
  /// Diagonal of the hat matrix at a sample.
  [[nodiscard]] float leverage(std::size_t sample_idx) const;
  /// Last direction that was added, orthonormal to the others with the ridge's rows; its
  /// projection of the colours.
  [[nodiscard]] auto last_direction() const {
    return directions_.col(static_cast<Eigen::Index>(terms_.count) - 1).head(rows_);
  }
  [[nodiscard]] Eigen::RowVector3f last_projection() const {
    return projections_.row(static_cast<Eigen::Index>(terms_.count) - 1);
  }
  /// The first `count` terms as a model of their own.
  [[nodiscard]] PatchModel model(std::size_t count) const;
  /// Position of the bump whose loss costs the penalised fit least; there must be one.
  [[nodiscard]] std::size_t weakest_bump() const;

 private:
  static constexpr int kRows = static_cast<int>(kMaxStoredSamples);
  static constexpr int kTerms = static_cast<int>(kMaxTerms);
  using Coefficients = Eigen::Matrix<float, kTerms, 3>;

  [[nodiscard]] Coefficients coefficients(Eigen::Index count) const;

  Eigen::Index rows_ = 0;
  TermList terms_;
  float degrees_of_freedom_ = 0;
  Eigen::Matrix<float, kRows, kTerms> directions_;
  Eigen::Matrix<float, kTerms, kTerms> factor_;  // lower triangular: Gram matrix = L L^T
  Eigen::Matrix<float, kTerms, 3> projections_;
  Eigen::Matrix<float, kRows, 3> residuals_;
};

}  // namespace sheen::fitting::sparse
