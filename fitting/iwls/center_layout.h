// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/options.h"

#include <Eigen/Core>

#include <vector>

namespace sheen::fitting::iwls {

/// Where the centres of a patch sit on the unit disc (paper, section 4.1): the cells of a
/// side x side grid over [-1, 1]^2, row by row (v outside, u inside).
/// grid: the cells' centres as they are; disk: through the concentric map (eq. 4); jittered: each
/// moved within its cell before the map, by an offset that depends on nothing but its index.
struct CenterLayout {
  Layout layout = Layout::grid;
  int side = 4;  ///< 4 or 8: a power of two
  std::vector<Eigen::Vector2f> centers;
};

/// `centers` is 16 or 64.
CenterLayout make_center_layout(Layout layout, int centers);

/// Centre of cell (x, y) of a coarser grid of `side` cells through the layout's map, without
/// jitter: the inner nodes of the quadtree.
Eigen::Vector2f coarse_node_position(Layout layout, int side, int x, int y);

/// Largest support radius: the quadtree's root and the start of the adaptive construction. With
/// sqrt 2 around the origin the rim of the disc still has weight.
inline constexpr double kRootRadius = 1.4142135623730951;

/// Radius of the quadtree's level with `side` cells per axis (eq. 9): kRootRadius / sqrt(side). At
/// the finest level it is also the radius of the partition of unity for every construction.
double level_radius(int side);

/// Distance of neighbouring cell centres of the grid.
double spacing(int side);

}  // namespace sheen::fitting::iwls
