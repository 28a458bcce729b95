// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/grow_groups.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <utility>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Of a large group so many members join at once, as a part of their number.
constexpr std::size_t kJoinPart = 16;

/// Neighbours of the members, those that the group draws best first.
std::vector<std::uint32_t> candidates_for(const ViewGroup& group, const Gram& gram,
                                          const ViewGraph& graph) {
  std::vector<std::uint32_t> views;
  for (const std::uint32_t member : group.members) {
    for (const std::uint32_t next : graph.neighbours(member)) {
      if (!std::ranges::binary_search(group.members, next)) views.push_back(next);
    }
  }
  std::ranges::sort(views);
  views.erase(std::unique(views.begin(), views.end()), views.end());
  std::vector<std::pair<double, std::uint32_t>> ranked;
  for (const std::uint32_t view : views) ranked.emplace_back(group.residual(gram, view), view);
  std::ranges::sort(ranked);
  for (std::size_t i = 0; i < views.size(); ++i) views[i] = ranked[i].second;
  return views;
}

ViewGroup group_of(std::vector<std::uint32_t> members, const Gram& gram, const GroupRule& rule) {
  std::ranges::sort(members);
  return principal_axes(gram, std::move(members), rule.most_eigenimages, rule.allowed());
}

ViewGroup seed_group(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                     std::uint32_t seed_view) {
  std::vector<std::uint32_t> members{seed_view};
  for (const std::uint32_t next : graph.neighbours(seed_view)) {
    if (members.size() < 3) members.push_back(next);
  }
  ViewGroup group = group_of(std::move(members), gram, rule);
  return rule.is_kept_by(group) ? group : group_of({seed_view}, gram, rule);
}

}  // namespace

bool GroupRule::is_kept_by(const ViewGroup& group) const {
  constexpr double worst = 1.5;
  constexpr double rounding = 1e-6;
  return group.residuals.mean() <= allowed() + rounding &&
         group.residuals.maxCoeff() <= worst * allowed() + rounding;
}

ViewGroup grow_group(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                     std::uint32_t seed_view) {
  ViewGroup group = seed_group(gram, graph, rule, seed_view);
  std::size_t joining = 1;
  while (joining > 0) {
    const auto candidates = candidates_for(group, gram, graph);
    joining = std::min(candidates.size(), 1 + group.members.size() / kJoinPart);
    for (; joining > 0; joining /= 2) {
      std::vector<std::uint32_t> members = group.members;
      members.insert(members.end(), candidates.begin(),
                     candidates.begin() + static_cast<std::ptrdiff_t>(joining));
      ViewGroup larger = group_of(std::move(members), gram, rule);
      if (!rule.is_kept_by(larger)) continue;
      group = std::move(larger);
      break;
    }
  }
  return group;
}

std::vector<ViewGroup> grow_groups(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                                   int threads) {
  std::vector<ViewGroup> groups((static_cast<std::size_t>(gram.rows()) + 1) / 2);
  core::parallel_for(
      groups.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          groups[i] = grow_group(gram, graph, rule, static_cast<std::uint32_t>(2 * i));
        }
      },
      1);
  return groups;
}

}  // namespace sheen::fitting::multi_eigenspace
