// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// No triangle lies there.
inline constexpr std::uint32_t kNoTriangle = 0xffffffffU;

/// For every triangle the one across each of its sides, or kNoTriangle: side i runs from corner i
/// to corner i + 1. Vertices of equal position count as one, so a surface goes on across a hard
/// edge. Where more than two triangles share an edge, the first two by index are neighbours.
std::vector<std::array<std::uint32_t, 3>> triangle_neighbours(const Mesh& mesh);

}  // namespace sheen::core
