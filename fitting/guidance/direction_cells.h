// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace sheen::fitting::guidance {

/// A set of cells of an 8 x 8 grid over [-1, 1]^2, which holds the disc of directions: bit 8 * row
/// + column, u growing with the column and v with the row.
using DirectionCells = std::uint64_t;

inline constexpr int kCellsPerSide = 8;
inline constexpr int kCellCount = kCellsPerSide * kCellsPerSide;

/// Cell of a direction, limited to the square.
int cell_of(const Eigen::Vector2f& uv);

inline DirectionCells cell_bit(int cell) {
  return DirectionCells{1} << cell;
}

/// Centre of a cell on the plane of the disc.
Eigen::Vector2f centre_of(int cell);

/// Cells whose centre lies on the disc.
DirectionCells disc_cells();

/// The set and all cells that touch one of its own, corners included.
DirectionCells dilated(DirectionCells cells);

/// How uncertain the radiance towards a cell is when the cells `seen` have been looked at, as a
/// share of what it is with none: 0 where seen, 1 from three cells on. The steps are those of a
/// Gaussian process whose correlation has fallen to .7 one cell away.
inline constexpr float kVarianceOneCellAway = 0.5f;
inline constexpr float kVarianceTwoCellsAway = 0.9f;
float predicted_variance(DirectionCells seen, int cell);

/// Sum of `predicted_variance` over the cells `wanted`.
float variance_sum(DirectionCells seen, DirectionCells wanted);

}  // namespace sheen::fitting::guidance
