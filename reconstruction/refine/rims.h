// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/refine/view_background.h"
#include "reconstruction/views/view_set.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::reconstruction {

/// Where a view shows the end of the surface: a point of the curve where the surface turns away
/// from the eye, between two vertices of an edge.
struct RimPoint {
  std::array<std::uint32_t, 2> vertices{};
  float share = 0;    ///< of the second vertex, [0, 1]
  float shift_m = 0;  ///< along the normal, by which the image wants it moved; positive: outwards
  float weight = 0;   ///< (0, 1]
  bool on_stage = false;  ///< seen against the stage, not against a farther part of the object
};

/// Finds the visible rims of the mesh in every view and where the images have them, to a fraction
/// of a pixel (study, step 5a). The share of the object's colour along the normal of the outline,
/// from the colours just within and those behind, says where it ends; `reach_px` to either side.
std::vector<RimPoint> find_rims(const ViewSet& views,
                                const std::vector<ViewBackground>& backgrounds,
                                const core::Mesh& mesh, float reach_px, int threads);

}  // namespace sheen::reconstruction
