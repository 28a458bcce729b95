// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/iwls/options.h"
#include "fitting/patch_fitter.h"

#include <memory>

namespace sheen::fitting::iwls {

/// Incremental weighted least squares (docs/algorithm.md). Samples with numbers that are not finite
/// are left out and not counted. The batch construction's model changes in `finish` only. Throws
/// std::invalid_argument for options that `check` refuses. `threads` >= 1.
std::unique_ptr<PatchFitter> make_iwls_fitter(const core::VertexNeighbours& neighbours,
                                              const Options& options, int threads);

}  // namespace sheen::fitting::iwls
