// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/stage/stage_map.h"

#include <vector>

namespace sheen::reconstruction {

/// The stage and how every view exposes it.
struct LearnedStage {
  StageMap map;
  std::vector<ViewGain> gains;  ///< per view
};

/// Learns the stage from views, with their exposures, and takes out what cannot be the board's
/// print. `masks` (CV_8UC1 per view, not 0: hides the stage) may be empty: then the object is told
/// by being where the rest of a texel's samples are not. With masks what no view shows is guessed.
LearnedStage learn_stage(const capture::Board& board, const ViewSet& views, const PlaneGrid& grid,
                         const std::vector<cv::Mat>& masks, int threads);

}  // namespace sheen::reconstruction
