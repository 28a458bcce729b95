// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/center_layout.h"

#include <cstddef>

namespace sheen::fitting::iwls {

inline constexpr std::size_t kLanes = 4;

/// Four sibling nodes side by side. Lanes without a node (the root has no siblings) stand so far
/// away that no sample reaches them.
template <typename Real>
struct Quad {
  Real u[kLanes], v[kLanes];
  Real radius, inverse_radius;
};

/// The nodes that the quadtree of a layout can have (eq. 9), by quads: the root's, that of its
/// children, then level after level in Morton order, so that the children of lane k of quad q > 0
/// are quad 4 (q - 1) + k + 2. Those of the last level are the layout's centres in the order of
/// `slots_of_centers`. Plain arrays: see lanes.h.
template <typename Real>
struct QuadTree {
  static constexpr std::size_t kMaxQuads = 1 + 1 + 4 + 16;

  /// All levels, or the centres only.
  QuadTree(const CenterLayout& layout, bool with_inner_nodes);

  [[nodiscard]] std::size_t finest_count() const { return quad_count - first_finest; }

  Quad<Real> quads[kMaxQuads];
  std::size_t quad_count = 0;
  std::size_t first_finest = 0;  ///< the first quad of centres
};

extern template struct QuadTree<float>;
extern template struct QuadTree<double>;

}  // namespace sheen::fitting::iwls
