// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/stage/stage_map.h"

#include <Eigen/Geometry>

#include <optional>

namespace sheen::reconstruction {

/// The rectangle that holds the board's tags, board frame, metres.
Eigen::AlignedBox2f tags_region(const capture::Board& board);

/// Colour of the board's paper in the open, BGR, [0, 1]; nothing where too little is seen.
std::optional<cv::Vec3f> paper_colour(const capture::Board& board, const StageMap& map);

/// Whether a colour can be that paper in the open or in shade.
bool looks_like_paper(const cv::Vec3f& colour, const cv::Vec3f& paper);

/// Forgets texels that cannot be the board's print: between the tags there is paper, of even colour
/// whatever its light. An object that hides a place from most views would else pass for it (study,
/// step 1). The forgotten set grows by four texels.
void refuse_what_is_no_print(const capture::Board& board, StageMap& map);

/// Guesses texels within the tags' region that no view shows, from the paper around them, so that
/// what would disprove an object there counts, if less.
void inpaint_hidden_paper(const capture::Board& board, StageMap& map);

}  // namespace sheen::reconstruction
