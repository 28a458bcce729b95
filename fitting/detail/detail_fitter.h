// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/detail/options.h"
#include "fitting/fitter.h"

#include <memory>

namespace sheen::fitting::detail {

/// A texture and patches (detail_light_field.h). While views arrive every texel is the mean of what
/// it showed, exactly, in whatever order they come; patches are fitted, as `sparse` does, to the
/// means of every view around the vertices. `finish` sharpens the texture to the one that explains
/// the pixels best (texture_solver.h). Takes 64 bytes per texel of the atlas, of which there are at
/// most eight millions. `mesh` outlives it; `threads` >= 1. Throws std::invalid_argument for bad
/// options.
std::unique_ptr<Fitter> make_detail_fitter(const core::Mesh& mesh, const Options& options,
                                           int threads);

}  // namespace sheen::fitting::detail
