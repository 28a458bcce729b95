// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/huge_pages.h"
#include "fitting/iwls/moment_rows.h"
#include "fitting/iwls/patch_fit.h"
#include "fitting/iwls/quad_kernels.h"

#include <cstdint>
#include <vector>

namespace sheen::fitting::iwls {

/// Two constructions that differ in when they solve.
///
/// The paper's hierarchical one (section 3.3.2): a node over the whole disc, split into four with
/// smaller supports where samples gather (eq. 9). A sample enters every leaf whose support covers
/// it. Leaves above the finest level are copied down to the centres they stand for. No sample is
/// stored: sums run at all nodes of all levels from the start, so a node that a split brings to
/// life already knows its samples, and nothing depends on the order of the views.
///
/// The reference of section 4.1, batch: every centre at its final radius from the start, solved
/// when all views are in. Until `solve` the model does not change.
///
/// Ridged fits are well conditioned and run in single precision; faithful ones may be nearly
/// singular and need double.
template <typename Real, std::size_t kTerms, bool kIncremental>
class QuadConstruction {
 public:
  QuadConstruction(const FitSettings& settings, std::size_t patch_count)
      : fit_{QuadTree<Real>(settings.layout, kIncremental), settings.rule,
             static_cast<Real>(settings.refine_above)},
        kernels_(quad_kernel_sets<Real>().front().of_terms(kTerms)),
        moments_(patch_count * reals_per_patch()) {
    flags_.reserve(patch_count * fit_.tree.quad_count);
    for (std::size_t patch = 0; patch < patch_count; ++patch) {
      for (std::size_t quad = 0; quad < fit_.tree.quad_count; ++quad) {
        flags_.push_back(initial_flags(quad, fit_.tree.first_finest));
      }
    }
  }

  FitOutcome integrate(std::size_t patch_idx, const Sample& sample, const Rgb& mean,
                       LightFieldModel& model) {
    const QuadPatch<Real> patch = patch_of(patch_idx, model);
    const QuadSample at{sample.u, sample.v, {sample.rgb[0], sample.rgb[1], sample.rgb[2]}};
    if constexpr (kIncremental) {
      return kernels_.integrate(fit_, patch, at, mean.data());
    } else {
      kernels_.gather(fit_, patch, at);
      return {};
    }
  }

  FitOutcome solve(std::size_t patch_idx, const Rgb& mean, LightFieldModel& model) {
    return kernels_.solve(fit_, patch_of(patch_idx, model), mean.data());
  }

  /// Asks for the memory that `integrate` will touch.
  void prefetch(std::size_t patch_idx, double u, double v, LightFieldModel& model) {
    kernels_.prefetch(fit_, patch_of(patch_idx, model), u, v);
  }

  static constexpr bool kSolvesAtOnce = kIncremental;

 private:
  [[nodiscard]] std::size_t reals_per_patch() const {
    return fit_.tree.quad_count * kLanes * MomentRows<kTerms>::kRows;
  }

  QuadPatch<Real> patch_of(std::size_t patch_idx, LightFieldModel& model) {
    return {moments_.data() + patch_idx * reals_per_patch(),
            flags_.data() + patch_idx * fit_.tree.quad_count, model.slots_of(patch_idx)};
  }

  QuadFit<Real> fit_;
  QuadKernels<Real> kernels_;
  std::vector<Real, HugePageAllocator<Real>> moments_;  // [patch][quad][row][lane]
  std::vector<std::uint8_t> flags_;                     // [patch][quad]
};

}  // namespace sheen::fitting::iwls
