// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh_file.h"

#include <filesystem>

namespace sheen::core {

/// The surface of a Wavefront OBJ file: `v`, `vn` and `f`, indices counted from the start or, when
/// negative, from the end. Every pair of position and normal that a face uses is one vertex, in
/// order of first use; texture coordinates, groups and materials split nothing, vertices that no
/// face uses are left out. Lines, points and curves are passed over. Colours are those of `v x y z
/// r g b`, in [0, 1], where all vertices have them. Throws Error (bad_input).
MeshFile read_obj(const std::filesystem::path& path, VertexColours colours);

}  // namespace sheen::core
