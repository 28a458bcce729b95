// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/eigen_texture/options.h"
#include "fitting/fitter.h"

#include <memory>

namespace sheen::fitting::eigen_texture {

/// The mean texture while views arrive, its bases in `finish` (fit_bases.h), which takes 8 bytes
/// per texel and view that saw it; or bases, too, while views arrive, from so much of them that
/// memory does not grow with the views (view_history.h). `mesh` outlives it; `threads` >= 1. Throws
/// std::invalid_argument for bad options.
std::unique_ptr<Fitter> make_eigen_fitter(const core::Mesh& mesh, const Options& options,
                                          int threads);

}  // namespace sheen::fitting::eigen_texture
