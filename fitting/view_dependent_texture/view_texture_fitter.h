// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/fitter.h"
#include "fitting/view_dependent_texture/options.h"

#include <memory>

namespace sheen::fitting::view_dependent_texture {

/// Keeps every photograph; nothing is solved. `mesh` outlives it; `threads` >= 1. Throws
/// std::invalid_argument for bad options.
std::unique_ptr<Fitter> make_view_texture_fitter(const core::Mesh& mesh, const Options& options,
                                                 int threads);

}  // namespace sheen::fitting::view_dependent_texture
