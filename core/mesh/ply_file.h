// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/mesh/mesh_file.h"

#include <filesystem>
#include <span>

namespace sheen::core {

/// Vertices and triangles of a PLY file as they lie there: ASCII or binary of either byte order,
/// properties of any scalar type, other elements and properties passed over. Faces are polygons,
/// concave ones too, or triangle strips with -1 between them; indices are checked. Throws Error
/// (bad_input), for vertices without x, y and z too.
MeshFile read_ply(const std::filesystem::path& path);

/// Writes a binary little-endian PLY with normals, beside the final name and then moved into place.
/// Coordinates are the mesh's own, without its offset. `confidence`, one number per vertex, becomes
/// a property of that name and the colour of the vertex, from red (0) over yellow to green (1); it
/// may be empty.
void write_ply(const std::filesystem::path& path, const Mesh& mesh,
               std::span<const float> confidence = {});

}  // namespace sheen::core
