// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/hull/distance_grid.h"
#include "reconstruction/object/work_progress.h"
#include "reconstruction/refine/view_background.h"
#include "reconstruction/views/view_set.h"

#include <vector>

namespace sheen::reconstruction {

/// What a surface is made from; all borrowed.
struct SurfaceInputs {
  const ViewSet& views;
  const std::vector<ViewBackground>& backgrounds;  ///< per view
  const core::Mesh& hull;                          ///< surface of the grid
  const DistanceGrid& grid;
  float pixel_m = 0;  ///< size of a pixel at the object
};

struct Surface {
  core::Mesh mesh;                ///< closed, manifold, without self-intersections
  std::vector<float> confidence;  ///< per vertex, [0, 1]
  float edge_m = 0;               ///< length that its edges were made for
  bool is_refined = false;        ///< else rims could not move it without triangles that cross
};

/// Triangles sized to the pixels on a hull, moved to where the images show its rims and made flat
/// between sharp edges where they do not tell (docs/mesh-from-session.md).
Surface make_surface_mesh(const SurfaceInputs& inputs, int threads, const WorkProgress& progress);

}  // namespace sheen::reconstruction
