// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/representation.h"

#include <memory>

namespace sheen::fitting::nearest_views {

/// Keeps all samples; nothing is solved. `threads` >= 1.
std::unique_ptr<Representation> make_nearest_representation(
    const core::VertexNeighbours& neighbours, int threads);

}  // namespace sheen::fitting::nearest_views
