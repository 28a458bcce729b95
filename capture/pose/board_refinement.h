// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <optional>
#include <vector>

namespace sheen::capture {

/// A board as its pictures say it is.
struct BoardRefinement {
  Board board;                ///< tags seen in too few pictures keep their place
  int views = 0;              ///< pictures that took part
  int tags = 0;               ///< tags that were moved
  double rms_before_px = 0;   ///< over the corners that took part, each view at its best pose
  double rms_after_px = 0;    ///< the same with the refined board
  double median_shift_m = 0;  ///< of the moved tags' centres
};

/// Joint refinement of where the tags lie and of every view's pose (bundle adjustment over tag
/// corners, Huber loss). Each tag stays a square; all sizes change by one common factor. The stage
/// frame and its scale stay: the refined tags are laid on the given ones by the best similarity, so
/// that T_stage_object keeps its meaning. `views` holds the tags detected in each picture, ids
/// unique within one. Nothing when fewer than three views pose or no two tags are seen together.
std::optional<BoardRefinement> refine_board(const Board& board, const core::CameraModel& camera,
                                            const std::vector<std::vector<TagDetection>>& views);

}  // namespace sheen::capture
