// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <optional>
#include <vector>

namespace sheen::capture {

/// A board as its images say it is.
struct BoardRefinement {
  Board board;                ///< tags seen in too few images keep their place
  core::CameraModel camera;   ///< the given one unless the lens was refined
  int views = 0;              ///< images that took part
  int tags = 0;               ///< tags that were moved
  double rms_before_px = 0;   ///< over the corners that took part, each view at its best pose
  double rms_after_px = 0;    ///< the same with the refined board
  double median_shift_m = 0;  ///< of the moved tags' centres
};

/// Whether focal lengths, principal point and distortion are refined, too.
enum class LensRefinement { off, on };

/// Joint refinement of where the tags lie and of every view's pose (bundle adjustment over tag
/// corners, Huber loss). Each tag stays a square but may lie anywhere and at any tilt: paper curls.
/// All sizes change by one common factor. The board frame and its scale stay: the refined tags are
/// laid on the given ones by the best similarity, so that T_stage_object keeps its meaning. `views`
/// holds the tags detected in each image, ids unique within one. With the lens, radial terms
/// beyond the second move only where `camera` has them; its views should be tilted by 15 degrees
/// and more, or focal length and distance cannot be told apart. Nothing when fewer than three views
/// pose or no two tags are seen together.
std::optional<BoardRefinement> refine_board(const Board& board, const core::CameraModel& camera,
                                            const std::vector<std::vector<TagDetection>>& views,
                                            LensRefinement lens = LensRefinement::off);

}  // namespace sheen::capture
