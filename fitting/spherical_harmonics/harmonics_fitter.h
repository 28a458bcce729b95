// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/patch_fitter.h"
#include "fitting/spherical_harmonics/options.h"

#include <memory>

namespace sheen::fitting::spherical_harmonics {

/// Least squares with a ridge on all terms but the constant, from running sums: no sample is kept,
/// the result does not depend on the order of the views but for rounding. `threads` >= 1. Throws
/// std::invalid_argument for options out of range.
std::unique_ptr<PatchFitter> make_harmonics_fitter(const core::VertexNeighbours& neighbours,
                                                   const Options& options, int threads);

}  // namespace sheen::fitting::spherical_harmonics
