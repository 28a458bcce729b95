// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

namespace sheen::reconstruction {

/// Moves vertices of triangles that cross each other to the middle of their neighbours, until none
/// cross; false where that does not part them. Normals are made anew where anything moved.
bool untangle(core::Mesh& mesh, int threads);

}  // namespace sheen::reconstruction
