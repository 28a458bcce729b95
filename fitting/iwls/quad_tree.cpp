// SPDX-License-Identifier: MIT
#include "fitting/iwls/quad_tree.h"

#include "fitting/iwls/slots.h"

#include <algorithm>
#include <vector>

namespace sheen::fitting::iwls {
namespace {

// Positions of the nodes of one level, row by row.
std::vector<Eigen::Vector2f> nodes_of_level(const CenterLayout& layout, int side) {
  if (side == layout.side) return layout.centers;
  std::vector<Eigen::Vector2f> nodes;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      nodes.push_back(coarse_node_position(layout.layout, side, x, y));
    }
  }
  return nodes;
}

template <typename Real>
constexpr Real kFarAway = 16;

}  // namespace

template <typename Real>
QuadTree<Real>::QuadTree(const CenterLayout& layout, bool with_inner_nodes) {
  for (int side = with_inner_nodes ? 1 : layout.side; side <= layout.side; side *= 2) {
    const std::vector<Eigen::Vector2f> nodes = nodes_of_level(layout, side);
    const std::vector<std::size_t> slots = slots_of_centers(nodes.size());
    const std::size_t first = quad_count;
    first_finest = first;
    quad_count += (nodes.size() + kLanes - 1) / kLanes;
    for (std::size_t quad = first; quad < quad_count; ++quad) {
      std::ranges::fill(quads[quad].u, kFarAway<Real>);
      std::ranges::fill(quads[quad].v, kFarAway<Real>);
      quads[quad].radius = static_cast<Real>(level_radius(side));
      quads[quad].inverse_radius = static_cast<Real>(1 / level_radius(side));
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Quad<Real>& quad = quads[first + slots[i] / kLanes];
      quad.u[slots[i] % kLanes] = static_cast<Real>(nodes[i].x());
      quad.v[slots[i] % kLanes] = static_cast<Real>(nodes[i].y());
    }
  }
}

template struct QuadTree<float>;
template struct QuadTree<double>;

}  // namespace sheen::fitting::iwls
