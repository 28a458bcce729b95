// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <cstddef>

namespace sheen::core {

/// The same surface with more vertices: edges longer than `max_edge_m` (> 0) are halved, round
/// after round, until none is left. When a round would exceed `max_vertices` (at most 2^32 - 1)
/// only its longest edges are halved, equal ones together, and the work ends. Vertices of `mesh`
/// keep their indices and come first; new ones lie on the flat triangles, with interpolated unit
/// normals. Triangles whose edges are all short stay as they are. Neighbouring triangles share
/// their new vertices, so no cracks open; hard edges (doubled vertices) stay hard, with new
/// vertices in equal places on both sides.
Mesh refine_mesh(const Mesh& mesh, float max_edge_m, std::size_t max_vertices);

}  // namespace sheen::core
