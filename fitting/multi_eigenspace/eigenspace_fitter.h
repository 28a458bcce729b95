// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/fitter.h"
#include "fitting/multi_eigenspace/options.h"

#include <memory>

namespace sheen::fitting::multi_eigenspace {

/// Keeps photographs and packs them into eigenspaces, anew whenever their number has doubled and at
/// the end. `mesh` outlives it; `threads` >= 1. Throws std::invalid_argument for bad options.
std::unique_ptr<Fitter> make_eigenspace_fitter(const core::Mesh& mesh, const Options& options,
                                               int threads);

}  // namespace sheen::fitting::multi_eigenspace
