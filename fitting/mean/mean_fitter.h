// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/patch_fitter.h"

#include <memory>

namespace sheen::fitting::mean {

/// The mean of all samples of a patch. `threads` >= 1.
std::unique_ptr<PatchFitter> make_mean_fitter(const core::VertexNeighbours& neighbours,
                                              int threads);

}  // namespace sheen::fitting::mean
