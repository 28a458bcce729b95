// SPDX-License-Identifier: MIT
#include "fitting/iwls/node_tree.h"

namespace sheen::fitting::iwls {
namespace {

Node node_at(const Eigen::Vector2f& position, double radius) {
  return {static_cast<double>(position.x()), static_cast<double>(position.y()), radius};
}

}  // namespace

NodeTree::NodeTree(const CenterLayout& layout) {
  // Place the nodes: inner levels without jitter, then the centres themselves.
  for (int side = 1; side < layout.side; side *= 2) {
    const std::size_t offset = nodes_.size();
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        nodes_.push_back(
            node_at(coarse_node_position(layout.layout, side, x, y), level_radius(side)));
      }
    }
    link(side, offset);
  }
  first_finest_ = nodes_.size();
  for (const Eigen::Vector2f& center : layout.centers) {
    nodes_.push_back(node_at(center, level_radius(layout.side)));
  }
  // Note who is whose parent, and which centres lie below a node.
  parents_.resize(nodes_.size(), 0);
  finest_below_.resize(nodes_.size());
  for (std::size_t node = nodes_.size(); node-- > 0;) {
    if (is_finest(node)) {
      finest_below_[node] = {static_cast<std::uint32_t>(node - first_finest_)};
      continue;
    }
    for (const std::uint32_t child : children_[node]) {
      parents_[child] = static_cast<std::uint32_t>(node);
      finest_below_[node].insert(finest_below_[node].end(), finest_below_[child].begin(),
                                 finest_below_[child].end());
    }
  }
}

// Children of the nodes of one level, which starts at `offset`; the next level follows it.
void NodeTree::link(int side, std::size_t offset) {
  const auto next = static_cast<std::uint32_t>(offset) + static_cast<std::uint32_t>(side * side);
  const auto stride = static_cast<std::uint32_t>(2 * side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const std::uint32_t first =
          next + static_cast<std::uint32_t>(2 * y) * stride + static_cast<std::uint32_t>(2 * x);
      children_.push_back({first, first + 1, first + stride, first + stride + 1});
    }
  }
}

NodeTree::Copy NodeTree::copy_to(std::size_t source, std::uint32_t center_idx) const {
  const Node& from = nodes_[source];
  const Node& to = nodes_[first_finest_ + center_idx];
  return {(to.u - from.u) / from.radius, (to.v - from.v) / from.radius, to.radius / from.radius};
}

}  // namespace sheen::fitting::iwls
