// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/center_layout.h"
#include "fitting/iwls/normal_equations.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::fitting::iwls {

/// All nodes the quadtree of a layout can have, level after level from the root; the nodes of the
/// last level are the layout's centres in order (eq. 9).
class NodeTree {
 public:
  /// How a node's polynomial becomes that of a finest centre: arguments of `re_expanded`.
  struct Copy {
    double shift_x, shift_y, scale;
  };

  explicit NodeTree(const CenterLayout& layout);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] bool is_finest(std::size_t node_idx) const { return node_idx >= first_finest_; }
  /// Only for nodes that are not finest.
  [[nodiscard]] const std::array<std::uint32_t, 4>& children(std::size_t node_idx) const {
    return children_[node_idx];
  }
  /// Parent of a node other than the root.
  [[nodiscard]] std::uint32_t parent(std::size_t node_idx) const { return parents_[node_idx]; }

  /// How a polynomial that belongs to `source` is stored at finest centre `center_idx`.
  [[nodiscard]] Copy copy_to(std::size_t source, std::uint32_t center_idx) const;

  /// The finest centres whose cells lie in the node's cell.
  [[nodiscard]] const std::vector<std::uint32_t>& finest_below(std::size_t node_idx) const {
    return finest_below_[node_idx];
  }

 private:
  void link(int side, std::size_t offset);

  std::vector<Node> nodes_;
  std::vector<std::array<std::uint32_t, 4>> children_;
  std::vector<std::uint32_t> parents_;
  std::vector<std::vector<std::uint32_t>> finest_below_;
  std::size_t first_finest_ = 0;
};

}  // namespace sheen::fitting::iwls
