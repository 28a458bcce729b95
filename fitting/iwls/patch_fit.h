// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/center_layout.h"
#include "fitting/iwls/light_field_model.h"
#include "fitting/iwls/solver.h"
#include "fitting/samples/patch_loop.h"

#include <cstddef>

namespace sheen::fitting::iwls {

/// What a construction needs to know besides its sums.
struct FitSettings {
  CenterLayout layout;
  FitRule rule;
  /// A node refines when it holds more samples than this: 4 x rank (paper, section 3.3).
  double refine_above = 12;
};

/// Fits a node and stores it at the finest centre it stands on.
template <std::size_t kTerms>
void fit_and_store(const NormalEquations<kTerms>& sums, const Rgb& prior, const FitRule& rule,
                   double scale, std::size_t patch_idx, std::size_t center_idx,
                   LightFieldModel& model, FitOutcome& outcome) {
  const Polynomial<kTerms> own = fit(sums, prior, rule);
  outcome.fits += sums.count > 0 ? 1 : 0;
  outcome.changed |= model.store(patch_idx, center_idx, re_expanded<kTerms>(own, 0.0, 0.0, scale));
}

}  // namespace sheen::fitting::iwls
