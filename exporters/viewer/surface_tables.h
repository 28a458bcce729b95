// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas_vertices.h"
#include "core/mesh/mesh.h"
#include "exporters/viewer/packed_arrays.h"

#include <nlohmann/json.hpp>

namespace sheen::exporters::viewer {

/// Adds the mesh as the page draws it: "positions" (in steps from the lowest corner), "normals",
/// "triangles" and, where a texture makes vertices repeat, "places" and "copies" (the patch of each
/// vertex behind the mesh's own). Returns lowest corner and step.
nlohmann::json add_surface(const core::Mesh& mesh, const core::AtlasVertices* split,
                           PackedArrays& tables);

/// The mesh with positions and normals as the page has them.
core::Mesh rounded_surface(const core::Mesh& mesh);

}  // namespace sheen::exporters::viewer
