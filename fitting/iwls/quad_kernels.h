// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/fit_rule.h"
#include "fitting/iwls/quad_tree.h"
#include "fitting/samples/fit_outcome.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::fitting::iwls {

/// What all patches of a fit share.
template <typename Real>
struct QuadFit {
  QuadTree<Real> tree;
  FitRule rule;
  Real refine_above;  ///< a node with more samples is split
};

/// One patch. `flags` has one byte per quad: in the low half the lanes that hold samples, in the
/// high half those with more than `refine_above`.
template <typename Real>
struct QuadPatch {
  Real* moments;                ///< [quad][MomentRows][lane], 64-byte aligned
  std::uint8_t* flags;          ///< [quad], at first `initial_flags`
  std::uint16_t* coefficients;  ///< halves [finest quad][term][r, g, b][lane]
};

/// What the flags of a patch without samples are: the root's quad has one node only.
constexpr std::uint8_t initial_flags(std::size_t quad, std::size_t first_finest) {
  return quad == 0 && first_finest > 0 ? 0xEE : 0x00;
}

struct QuadSample {
  double u, v;
  double rgb[3];
};

/// The inner loops of quadtree and batch for one instruction set. All give the same bits. Templates
/// of the number of terms.
template <typename Real>
struct QuadKernels {
  /// Adds a sample to all nodes whose support holds it.
  void (*gather)(const QuadFit<Real>&, const QuadPatch<Real>&, const QuadSample&);
  /// The same, then fits the leaves it concerns. `prior` is the mean colour of the patch.
  FitOutcome (*integrate)(const QuadFit<Real>&, const QuadPatch<Real>&, const QuadSample&,
                          const double* prior);
  /// Fits all leaves.
  FitOutcome (*solve)(const QuadFit<Real>&, const QuadPatch<Real>&, const double* prior);
  /// Asks for the memory that `integrate` will touch.
  void (*prefetch)(const QuadFit<Real>&, const QuadPatch<Real>&, double u, double v);
};

/// Where the centres of a model stand, quads of four.
struct QuadCenters {
  const float* u;  ///< [quad][lane]
  const float* v;
  std::size_t quad_count;
  float inverse_radius;
};

/// Evaluates a patch of a model at (u, v): `sums` become the colour sum r, g, b and the weight sum
/// of eq. 7. `coefficients` are halves [quad][term][r, g, b][lane].
using Evaluate = void (*)(const QuadCenters&, const std::uint16_t* coefficients, float u, float v,
                          float* sums);

struct EvaluateKernels {
  Evaluate one_term, three_terms, six_terms;

  [[nodiscard]] Evaluate of_terms(int terms) const {
    return terms == 1 ? one_term : (terms == 3 ? three_terms : six_terms);
  }
};

/// The fastest that this processor can run.
const EvaluateKernels& evaluate_kernels();

/// One way to run the kernels on this processor.
template <typename Real>
struct QuadKernelSet {
  std::string_view instruction_set;  ///< "portable", "avx2"
  QuadKernels<Real> one_term, three_terms, six_terms;

  [[nodiscard]] const QuadKernels<Real>& of_terms(std::size_t terms) const {
    return terms == 1 ? one_term : (terms == 3 ? three_terms : six_terms);
  }
};

/// All that this processor can run, the fastest first; "portable" is always among them.
template <typename Real>
const std::vector<QuadKernelSet<Real>>& quad_kernel_sets();
template <>
const std::vector<QuadKernelSet<float>>& quad_kernel_sets();
template <>
const std::vector<QuadKernelSet<double>>& quad_kernel_sets();

}  // namespace sheen::fitting::iwls
