// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <filesystem>

namespace sheen::core {

/// Vertices and triangles of a PLY file as they lie there: ASCII or binary of either byte order,
/// properties of any scalar type, other elements and properties passed over. `normals` stays empty
/// when the file has none; polygons (taken to be convex) are cut into fans; indices are checked.
/// Throws Error (bad_input). assimp reads PLY, too, but loops forever on headers cut short.
Mesh read_ply(const std::filesystem::path& path);

/// Writes a binary little-endian PLY with normals, beside the final name and then moved into place.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace sheen::core
