// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <filesystem>

namespace sheen::core {

/// Reads PLY, OBJ or GLB. Vertices keep the order of the file; vertices no triangle uses are kept,
/// so that patch indices mean vertex indices. OBJ corners that share a position and a normal become
/// one vertex. Missing normals are computed, weighted by angle; degenerate triangles are dropped.
/// Throws Error (bad_input) for unreadable files, no triangles, NaN or infinite positions.
Mesh read_mesh(const std::filesystem::path& path);

/// Writes a binary little-endian PLY with normals, beside the final name and then moved into place.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace sheen::core
