// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/hull/distance_grid.h"
#include "reconstruction/stereo/depth_maps.h"

namespace sheen::reconstruction {

/// Undoes what was carved of a hull wherever the views that no depth was found from (`is_judge`) do
/// not show it. Every connected region that was carved away is judged by itself: the pixels of
/// these views that look at it, predicted from the neighbouring views by the surface below it, must
/// come out clearly better than by the hull. A pixel before which nothing is left counts as missed.
/// `hull` and `carved` have the same points, and `maps` were found on that hull.
void keep_proven_carving(const DepthMaps& maps, const DistanceGrid& hull, int threads,
                         DistanceGrid& carved);

}  // namespace sheen::reconstruction
