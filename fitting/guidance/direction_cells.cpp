// SPDX-License-Identifier: MIT
#include "fitting/guidance/direction_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sheen::fitting::guidance {
namespace {

constexpr DirectionCells kFirstColumn = 0x0101010101010101;
constexpr DirectionCells kLastColumn = 0x8080808080808080;

int column_of(float coordinate) {
  // Not a number ends up in the first column: comparisons with it are false.
  const float scaled = (coordinate + 1) * (0.5f * kCellsPerSide);
  if (!(scaled > 0)) return 0;
  return static_cast<int>(std::min(scaled, kCellsPerSide - 0.5f));
}

}  // namespace

int cell_of(const Eigen::Vector2f& uv) {
  return kCellsPerSide * column_of(uv.y()) + column_of(uv.x());
}

Eigen::Vector2f centre_of(int cell) {
  constexpr float step = 2.0f / kCellsPerSide;
  return {-1 + step * (static_cast<float>(cell % kCellsPerSide) + 0.5f),
          -1 + step * (static_cast<float>(cell / kCellsPerSide) + 0.5f)};
}

DirectionCells disc_cells() {
  static const DirectionCells cells = [] {
    DirectionCells found = 0;
    for (int cell = 0; cell < kCellCount; ++cell) {
      if (centre_of(cell).norm() <= 1) found |= cell_bit(cell);
    }
    return found;
  }();
  return cells;
}

DirectionCells dilated(DirectionCells cells) {
  const DirectionCells row = cells | ((cells & ~kLastColumn) << 1) | ((cells & ~kFirstColumn) >> 1);
  return row | (row << kCellsPerSide) | (row >> kCellsPerSide);
}

float predicted_variance(DirectionCells seen, int cell) {
  return variance_sum(seen, cell_bit(cell));
}

float variance_sum(DirectionCells seen, DirectionCells wanted) {
  const DirectionCells near = dilated(seen);
  const DirectionCells far = dilated(near);
  const auto count = [&](DirectionCells cells) {
    return static_cast<float>(std::popcount(cells & wanted));
  };
  return kVarianceOneCellAway * count(near & ~seen) + kVarianceTwoCellsAway * count(far & ~near) +
         count(~far);
}

}  // namespace sheen::fitting::guidance
