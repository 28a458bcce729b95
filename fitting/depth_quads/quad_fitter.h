// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/depth_quads/options.h"
#include "fitting/fitter.h"

#include <memory>

namespace sheen::fitting::depth_quads {

/// Cuts every photograph into quads where it shows the mesh, at the depths that a sensor measured
/// there or, where an observation has none or `options` say so, at those of the mesh; nothing is
/// solved, and a photograph is drawn as soon as it is integrated. `mesh` outlives it; `threads`
/// >= 1. Throws std::invalid_argument for bad options.
std::unique_ptr<Fitter> make_quad_fitter(const core::Mesh& mesh, const Options& options,
                                         int threads);

}  // namespace sheen::fitting::depth_quads
