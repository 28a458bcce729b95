// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/multi_eigenspace/grow_groups.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// Every view in one group.
struct Partition {
  std::vector<ViewGroup> groups;      ///< each of its own views; none empty
  std::vector<std::uint32_t> owners;  ///< of every view
  std::size_t grown = 0;              ///< groups that there were to choose from
};

/// Groups grown from many views, those chosen that describe the views best, all views shared out
/// among them; where one would be drawn with more than twice the tolerance, a group more, and
/// where the others can take a group's views within the tolerance, one less. There is at least one
/// view.
Partition partition_views(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                          int threads);

}  // namespace sheen::fitting::multi_eigenspace
