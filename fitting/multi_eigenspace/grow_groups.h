// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/multi_eigenspace/view_graph.h"
#include "fitting/multi_eigenspace/view_group.h"

#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// What a group of views must keep to.
struct GroupRule {
  int most_eigenimages;
  double
      tolerance;  ///< RMS of its views, grey levels; one view may have 1.5 times the squared error

  [[nodiscard]] double allowed() const { return tolerance * tolerance; }
  [[nodiscard]] bool is_kept_by(const ViewGroup& group) const;
};

/// A group grown from a view and its two nearest neighbours: of all neighbours of its members the
/// view joins that the group draws best, as long as the rule is kept.
ViewGroup grow_group(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                     std::uint32_t seed_view);

/// One from every second view. The same on any number of threads.
std::vector<ViewGroup> grow_groups(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                                   int threads);

}  // namespace sheen::fitting::multi_eigenspace
