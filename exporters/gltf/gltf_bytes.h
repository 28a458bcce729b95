// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "exporters/splats/splats.h"
#include "fitting/texture/surface_texture.h"

#include <filesystem>
#include <string>

namespace sheen::exporters::gltf {

/// A binary glTF 2.0 file with a mesh, unlit, and its texture. `texture` lies on an atlas of
/// `mesh`. Throws core::Error (run_failed) beyond 4 GiB; `path` is for messages.
std::string textured_bytes(const std::filesystem::path& path, const core::Mesh& mesh,
                           const fitting::SurfaceTexture& texture);

/// The same with splats: points with the attributes of KHR_gaussian_splatting, and linear COLOR_0
/// for readers that do not know it.
std::string splat_bytes(const std::filesystem::path& path, const Splats& splats);

}  // namespace sheen::exporters::gltf
