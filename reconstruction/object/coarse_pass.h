// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/hull/distance_grid.h"
#include "reconstruction/object/shape.h"
#include "reconstruction/object/work_progress.h"
#include "reconstruction/stage/stage_map.h"
#include "reconstruction/views/view_set.h"

#include <Eigen/Geometry>

namespace sheen::reconstruction {

/// Passes until a coarse shape has settled.
inline constexpr int kCoarsePasses = 5;

/// How finely a pass looks.
struct CoarseGrids {
  PlaneGrid stage;             ///< on which the sheet is learned
  Eigen::AlignedBox2f region;  ///< above which the object is looked for, board frame, metres
  int cells = 0;               ///< of the hull, along its longest side
};

/// What a pass found.
struct CoarseHull {
  DistanceGrid grid;
  StageMap stage;
  float paper_share = 0;  ///< of what was cut out (outline_pass.h)
};

/// One pass towards a coarse shape: learns the stage beside the shape of the pass before (null: the
/// object is told by being where the rest of a texel's samples are not), cuts the object out of
/// every view and intersects what was cut out. Early passes, counted from 0, let more views be
/// wrong: what they miss would be learned as stage.
CoarseHull carve_coarsely(const capture::Board& board, const ViewSet& views,
                          const CoarseGrids& grids, int pass, const Shape* before, int threads,
                          const WorkProgress& progress);

}  // namespace sheen::reconstruction
