// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

namespace sheen::core {

/// Steps from what mesh files hold to the invariants of Mesh. Triangles must index existing
/// vertices and positions must be finite.

/// Makes one vertex of all that share exactly the same position and normal, in order of first use
/// by a triangle; vertices that no triangle uses are lost. `colours`, empty or one for every
/// vertex, keep vertices of different colours apart and follow.
void join_identical_vertices(Mesh& mesh, std::vector<Eigen::Vector3f>& colours);

/// Drops triangles with a repeated corner or without area.
void drop_degenerate_triangles(Mesh& mesh);

/// Turns triangles and normals of a closed surface (every edge, by position, runs once in either
/// direction) whose enclosed volume is negative. Open surfaces stay as they are.
void turn_inside_out_surface(Mesh& mesh);

/// Whether every edge, by position, runs once in either direction.
bool is_closed(const Mesh& mesh);

/// Gives every normal unit length; those that are zero, not finite or missing (`normals` may be
/// empty) become the sum of the normals of the triangles around, weighted by their angle at the
/// vertex. Where that sum is zero a triangle's own normal serves, without triangles (0, 0, 1).
void complete_normals(Mesh& mesh);

}  // namespace sheen::core
