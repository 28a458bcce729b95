// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/hull/distance_grid.h"
#include "reconstruction/stereo/depth_maps.h"

namespace sheen::reconstruction {

/// Carves what silhouettes leave standing and stereo looks through: roofs over hollows and flat
/// tops. A grid point's value becomes at least the lower quartile, over the views whose depth there
/// is known and which do not see it behind the surface, of how far it lies in front of the surface
/// (at most `limit_m`). Depths just below the hull hold it where it is: there outlines know better.
/// Nothing is added to the hull; points about which fewer than three views know stay.
void carve_roofs(const DepthMaps& maps, float limit_m, int threads, DistanceGrid& grid);

}  // namespace sheen::reconstruction
