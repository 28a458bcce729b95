// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/patch_fitter.h"

#include <memory>

namespace sheen::fitting::nearest_views {

/// Keeps all samples; nothing is solved. `threads` >= 1.
std::unique_ptr<PatchFitter> make_nearest_fitter(const core::VertexNeighbours& neighbours,
                                                 int threads);

}  // namespace sheen::fitting::nearest_views
