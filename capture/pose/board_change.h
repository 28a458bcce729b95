// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::capture {

/// How one tag lies differently on two boards.
struct TagChange {
  int id = 0;
  Eigen::Vector3d shift_m;  ///< of its centre, board frame
  double tilt_rad = 0;      ///< between its planes
};

/// Changes of the tags that both boards hold, by id.
std::vector<TagChange> compare_boards(const Board& before, const Board& after);

/// Seen from above: the tags before (grey) and after (blue, red where higher, green where lower),
/// their shifts as arrows made longer by the factor that is written below. CV_8UC3.
cv::Mat draw_board_change(const Board& before, const Board& after);

}  // namespace sheen::capture
