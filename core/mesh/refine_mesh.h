// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

namespace sheen::core {

/// The same surface with more vertices: edges longer than `max_edge_m` (> 0) are halved until none
/// is left or the next round would exceed `max_vertices`. Vertices of `mesh` keep their indices and
/// come first; new ones lie on the flat triangles, with interpolated unit normals. Neighbouring
/// triangles share their new vertices, so no cracks open; hard edges (doubled vertices) stay hard.
Mesh refine_mesh(const Mesh& mesh, float max_edge_m, std::size_t max_vertices);

}  // namespace sheen::core
