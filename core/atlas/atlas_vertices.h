// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"

#include <cstdint>
#include <vector>

namespace sheen::core {

/// The vertices of a mesh, each as often as it has places on an atlas: what graphics libraries draw
/// and files hold, which know one place per vertex.
struct AtlasVertices {
  /// Of the mesh. Its own vertices come first, in their order; copies follow.
  std::vector<std::uint32_t> vertex;
  std::vector<AtlasPoint> place;
  decltype(Mesh::triangles) triangles;  ///< indices into `vertex`
};

/// Copies vertices where charts meet. Vertices of no triangle lie at the atlas' origin.
AtlasVertices split_at_seams(const Mesh& mesh, const Atlas& atlas);

/// The places of every triangle's corners again: the inverse. `triangles` are those of the split
/// mesh and name existing places.
std::vector<std::array<AtlasPoint, 3>> corners_of(const std::vector<AtlasPoint>& places,
                                                  const decltype(Mesh::triangles)& triangles);

}  // namespace sheen::core
