// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace sheen::core {

/// From where a vertex was looked at: set bits of an 8 x 8 grid of directions, and how far its
/// colours can be trusted over all of them, in [0, 1] (docs/formats.md, `seen`).
struct VertexConfidence {
  std::uint64_t seen = 0;
  float mean = 0;
};

/// Writes a binary little-endian PLY of triangles with normals and colours (`red green blue`,
/// bytes), beside the final name and then moved into place. `colours`: sRGB in [0, 1], one per
/// vertex. Coordinates are the mesh's file's, its offset included: in double precision where there
/// is one. `confidence`: one per vertex, or none; it becomes `confidence` and `seen_0` to `seen_3`,
/// the lowest 16 bits first.
void write_coloured_ply(const std::filesystem::path& path, const Mesh& mesh,
                        std::span<const Eigen::Vector3f> colours,
                        std::span<const VertexConfidence> confidence = {});

}  // namespace sheen::core
