// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/hull/distance_grid.h"

namespace sheen::reconstruction {

/// The surface phi = 0 of a grid, every cell cut into six tetrahedra. The field is linear in each
/// of them, so the surface is closed, manifold and free of self-intersections whatever the values
/// are, provided that the grid's boundary is outside (which is enforced). Triangles are
/// counter-clockwise seen from outside; vertices ordered by place, normals complete. Empty for a
/// grid without inside.
core::Mesh march_tetrahedra(const DistanceGrid& grid);

}  // namespace sheen::reconstruction
