// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"

namespace sheen::core {

/// Neighbours by edges and, at a seam (vertices doubled for their normals or texture), the vertices
/// at exactly the same position: so that a walk over the surface does not end at a sharp edge.
VertexNeighbours seamless_neighbours(const Mesh& mesh);

}  // namespace sheen::core
