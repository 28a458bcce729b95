// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace sheen::reconstruction {

/// Pairs of triangles that cross each other: an edge of one passes through the inside of the other.
/// Neighbours that share a vertex are asked about what they do not share; those that share an edge
/// cross when one is folded flat onto the other. The first index of a pair is the smaller one.
std::vector<std::pair<std::uint32_t, std::uint32_t>> find_self_intersections(const core::Mesh& mesh,
                                                                             int threads);

/// Whether every edge has exactly two triangles, one in either direction, and every vertex one fan.
bool is_closed_manifold(const core::Mesh& mesh);

}  // namespace sheen::reconstruction
