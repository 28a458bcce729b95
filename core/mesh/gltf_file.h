// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh_file.h"

#include <filesystem>

namespace sheen::core {

/// The surface of a binary glTF 2.0 file in the coordinates of its scene: transforms of nodes are
/// applied, several meshes become one; triangles, strips and fans. Read: KHR_mesh_quantization,
/// EXT_meshopt_compression, KHR_draco_mesh_compression, EXT_mesh_gpu_instancing, CESIUM_RTC.
/// Extensions about materials and the like are passed over, another that the file requires is
/// refused by its name. Skins and morph targets are passed over with a note. Throws Error
/// (bad_input). Colours are as core/mesh/gltf_colours.h has them.
MeshFile read_glb(const std::filesystem::path& path, VertexColours colours);

}  // namespace sheen::core
