// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/billboard/options.h"
#include "fitting/fitter.h"

#include <memory>

namespace sheen::fitting::billboard {

/// Fits another light field and bakes frames of it: while views come the frame that is nearest to
/// each, at the end all of them. `mesh` outlives it; `threads` >= 1. Throws std::invalid_argument
/// for bad options.
std::unique_ptr<Fitter> make_billboard_fitter(const core::Mesh& mesh, const Options& options,
                                              int threads);

}  // namespace sheen::fitting::billboard
