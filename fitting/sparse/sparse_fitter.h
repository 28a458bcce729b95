// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/patch_fitter.h"
#include "fitting/sparse/options.h"

#include <memory>

namespace sheen::fitting::sparse {

/// Patches with as many terms as their samples ask for: one colour, a linear base, RBFs
/// (patch_model.h). While views arrive a patch is looked at again when a sample was predicted badly
/// or its samples have grown by a third; `finish` chooses the terms of every touched patch anew,
/// which makes the result independent of the order of views as long as all samples are kept.
/// `threads` >= 1. Throws std::invalid_argument for bad options.
std::unique_ptr<PatchFitter> make_sparse_fitter(const core::VertexNeighbours& neighbours,
                                                const Options& options, int threads);

}  // namespace sheen::fitting::sparse
