// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/mesh/ply_file.h"  // write_ply

#include <filesystem>

namespace sheen::core {

/// Reads PLY, OBJ or GLB; transforms of nodes are applied, several meshes become one.
/// Polygons are cut into triangles, degenerate triangles are dropped. PLY and glTF: vertices keep
/// number and order of the file, also those that no triangle uses and those that share a position
/// (hard edges), so that patch indices mean vertex indices. OBJ: corners that share a position and
/// a normal become one vertex, in order of first use; texture coordinates, groups and materials do
/// not split vertices. Missing, zero or unusable normals are computed, weighted by angle; vertices
/// that no triangle uses get (0, 0, 1) then. A closed surface wound inside out (negative volume) is
/// turned, with its normals. Throws Error (bad_input) for unreadable files, no triangles, NaN or
/// infinite positions.
Mesh read_mesh(const std::filesystem::path& path);

}  // namespace sheen::core
