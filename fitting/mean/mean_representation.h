// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/representation.h"

#include <memory>

namespace sheen::fitting::mean {

/// The mean of all samples of a patch. `threads` >= 1.
std::unique_ptr<Representation> make_mean_representation(const core::VertexNeighbours& neighbours,
                                                         int threads);

}  // namespace sheen::fitting::mean
