// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/coloured_ply.h"
#include "core/mesh/mesh.h"
#include "exporters/splats/splats.h"
#include "fitting/texture/surface_texture.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::exporters::gltf {

/// A binary glTF 2.0 file with a mesh, unlit, and its texture. `texture` lies on an atlas of
/// `mesh`. `confidence`: one per vertex, or none; it becomes `_CONFIDENCE` and `_SEEN`. Throws
/// core::Error (run_failed) beyond 4 GiB; `path` is for messages.
std::string textured_bytes(const std::filesystem::path& path, const core::Mesh& mesh,
                           const fitting::SurfaceTexture& texture,
                           const std::vector<core::VertexConfidence>& confidence);

/// The same with splats: points with the attributes of KHR_gaussian_splatting, and linear COLOR_0
/// for readers that do not know it. `confidence` as above, one per vertex of the mesh.
std::string splat_bytes(const std::filesystem::path& path, const Splats& splats,
                        const std::vector<core::VertexConfidence>& confidence);

}  // namespace sheen::exporters::gltf
