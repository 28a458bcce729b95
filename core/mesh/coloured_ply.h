// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <filesystem>
#include <span>

namespace sheen::core {

/// Writes a binary little-endian PLY of triangles with normals and colours (`red green blue`,
/// bytes), beside the final name and then moved into place. `colours`: sRGB in [0, 1], one per
/// vertex. Coordinates are the mesh's file's, its offset included: in double precision where there
/// is one.
void write_coloured_ply(const std::filesystem::path& path, const Mesh& mesh,
                        std::span<const Eigen::Vector3f> colours);

}  // namespace sheen::core
