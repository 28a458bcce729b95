// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_family.h"

#include <Eigen/Core>

#include <map>
#include <vector>

namespace sheen::capture {

/// What a tag shows: the bits of its code and on which side of its border paper lies.
struct TagPattern {
  struct Cell {
    Eigen::Vector2d centre;  ///< tag frame (x right, y up on the print), in sides of the square
    bool is_white = false;
  };
  std::vector<Cell> bits;
  bool is_black_inside = true;  ///< false for the families with a white square on black
};

/// Patterns of the board's tags by id, as libapriltag and OpenCV print them (Kalibr's turned). Ids
/// that the family does not hold are left out.
std::map<int, TagPattern> find_tag_patterns(const TagFamily& family, const Board& board);

}  // namespace sheen::capture
