// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/apriltag_family.h"

#include <vector>

namespace sheen::capture {

/// A tag as libapriltag prints it: square modules, row 0 on top.
struct TagBitmap {
  int modules = 0;             ///< across the whole bitmap
  int modules_across_tag = 0;  ///< across the black square, which is the middle of the bitmap
  std::vector<bool> black;     ///< row-major, modules * modules

  [[nodiscard]] bool is_black(int row, int column) const {
    return black[static_cast<std::size_t>(row) * static_cast<std::size_t>(modules) +
                 static_cast<std::size_t>(column)];
  }
};

/// `id` must be one of the family's codes.
TagBitmap draw_tag(const AprilTagFamily& family, int id);

}  // namespace sheen::capture
