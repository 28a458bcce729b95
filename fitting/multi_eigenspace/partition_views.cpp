// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/partition_views.h"

#include "fitting/multi_eigenspace/select_groups.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Rounds of sharing out views and fitting their groups anew.
constexpr int kRounds = 4;
/// What a neighbour in another group costs, in squared tolerances: borders of groups stay short.
constexpr double kBorderCost = 1;
/// A view drawn worse than so many tolerances asks for a group more.
constexpr double kWorst = 2;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class Sharing {
 public:
  Sharing(const Gram& gram, const ViewGraph& graph, const GroupRule& rule)
      : gram_(gram), graph_(graph), rule_(rule) {}

  /// The members to their groups, and group by group what lies next to them.
  void share_out(std::vector<ViewGroup> groups);
  /// Views to groups that draw them well and have their neighbours, groups from their views.
  void refine();
  /// Adds groups where views are drawn badly; some views may stay so.
  void add_missing();
  /// Leaves out groups whose views others can take within the tolerance.
  void drop_needless();

  [[nodiscard]] Partition result(std::size_t grown) && {
    return {std::move(groups_), std::move(owners_), grown};
  }

 private:
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(gram_.rows()); }
  [[nodiscard]] double error(std::size_t view, std::uint32_t group_idx) const {
    return errors_(static_cast<Eigen::Index>(view), group_idx);
  }
  bool join_best();
  [[nodiscard]] bool is_good() const;
  [[nodiscard]] double border_cost(std::size_t view, std::uint32_t group_idx) const;
  void find_errors();
  void fit_groups();

  const Gram& gram_;
  const ViewGraph& graph_;
  const GroupRule& rule_;
  std::vector<ViewGroup> groups_;
  std::vector<std::uint32_t> owners_;
  Eigen::MatrixXd errors_;  ///< mean squared, [view][group]
};

void Sharing::find_errors() {
  errors_.resize(gram_.rows(), static_cast<Eigen::Index>(groups_.size()));
  for (std::size_t view = 0; view < count(); ++view) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      errors_(static_cast<Eigen::Index>(view), static_cast<Eigen::Index>(g)) =
          groups_[g].residual(gram_, static_cast<std::uint32_t>(view));
    }
  }
}

void Sharing::share_out(std::vector<ViewGroup> groups) {
  groups_ = std::move(groups);
  find_errors();
  owners_.assign(count(), kNone);
  for (std::uint32_t g = 0; g < groups_.size(); ++g) {
    for (const std::uint32_t view : groups_[g].members) {
      if (owners_[view] == kNone || error(view, g) < error(view, owners_[view])) owners_[view] = g;
    }
  }
  while (join_best()) {
  }
  fit_groups();
}

/// Of the views without a group the one joins that a neighbour's group draws best; where none has
/// such a neighbour, of all groups. False when all have one.
bool Sharing::join_best() {
  std::size_t best_view = count();
  std::uint32_t best_group = kNone;
  bool is_next_to_it = false;
  for (std::size_t view = 0; view < count(); ++view) {
    if (owners_[view] != kNone) continue;
    const auto consider = [&](std::uint32_t g, bool is_next) {
      if (g == kNone || is_next < is_next_to_it) return;
      if (is_next == is_next_to_it && best_view < count() &&
          error(view, g) >= error(best_view, best_group)) {
        return;
      }
      best_view = view;
      best_group = g;
      is_next_to_it = is_next;
    };
    for (const std::uint32_t next : graph_.neighbours(view)) consider(owners_[next], true);
    for (std::uint32_t g = 0; g < groups_.size(); ++g) consider(g, false);
  }
  if (best_view < count()) owners_[best_view] = best_group;
  return best_view < count();
}

/// Groups without a view go.
void Sharing::fit_groups() {
  std::vector<std::vector<std::uint32_t>> members(groups_.size());
  for (std::size_t view = 0; view < count(); ++view) {
    members[owners_[view]].push_back(static_cast<std::uint32_t>(view));
  }
  groups_.clear();
  for (auto& own : members) {
    if (own.empty()) continue;
    for (const std::uint32_t view : own) owners_[view] = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back(
        principal_axes(gram_, std::move(own), rule_.most_eigenimages, rule_.allowed()));
  }
  find_errors();
}

double Sharing::border_cost(std::size_t view, std::uint32_t group_idx) const {
  const auto& neighbours = graph_.neighbours(view);
  if (neighbours.empty()) return 0;
  const auto others = std::ranges::count_if(
      neighbours, [&](std::uint32_t next) { return owners_[next] != group_idx; });
  return kBorderCost * rule_.allowed() * static_cast<double>(others) /
         static_cast<double>(neighbours.size());
}

void Sharing::refine() {
  for (int round = 0; round < kRounds; ++round) {
    bool changed = false;
    for (std::size_t view = 0; view < count(); ++view) {
      const auto cost_in = [&](std::uint32_t group_idx) {
        return error(view, group_idx) + border_cost(view, group_idx);
      };
      std::uint32_t best = owners_[view];
      for (const std::uint32_t next : graph_.neighbours(view)) {
        if (cost_in(owners_[next]) < cost_in(best)) best = owners_[next];
      }
      changed = changed || best != owners_[view];
      owners_[view] = best;
    }
    if (!changed) return;
    fit_groups();
  }
}

void Sharing::add_missing() {
  std::vector<std::uint8_t> tried(count(), 0);
  while (true) {
    const double worst = kWorst * kWorst * rule_.allowed();
    std::size_t view = count();
    double most = worst;
    for (std::size_t i = 0; i < count(); ++i) {
      if (tried[i] != 0 || error(i, owners_[i]) <= most) continue;
      most = error(i, owners_[i]);
      view = i;
    }
    if (view == count()) return;
    tried[view] = 1;
    // Of its group's views those go over that it draws better, the view itself at least.
    const ViewGroup more = grow_group(gram_, graph_, rule_, static_cast<std::uint32_t>(view));
    const auto added = static_cast<std::uint32_t>(groups_.size());
    for (const std::uint32_t member : more.members) {
      if (member == view || more.residual(gram_, member) < error(member, owners_[member])) {
        owners_[member] = added;
      }
    }
    groups_.push_back(more);
    fit_groups();
    refine();
  }
}

/// Whether the views are drawn within the tolerance on the mean, and none badly.
bool Sharing::is_good() const {
  double sum = 0;
  double most = 0;
  for (std::size_t view = 0; view < count(); ++view) {
    sum += error(view, owners_[view]);
    most = std::max(most, error(view, owners_[view]));
  }
  return sum <= rule_.allowed() * static_cast<double>(count()) &&
         most <= kWorst * kWorst * rule_.allowed();
}

void Sharing::drop_needless() {
  if (!is_good()) return;
  for (std::size_t g = 0; g < groups_.size() && groups_.size() > 1;) {
    Sharing without = *this;
    for (std::uint32_t& owner : without.owners_) {
      if (owner == g) owner = kNone;
    }
    without.groups_[g].members.clear();
    without.errors_.col(static_cast<Eigen::Index>(g))
        .setConstant(std::numeric_limits<double>::max());
    while (without.join_best()) {
    }
    without.fit_groups();
    without.refine();
    if (!without.is_good()) {
      ++g;
      continue;
    }
    groups_ = std::move(without.groups_);
    owners_ = std::move(without.owners_);
    errors_ = std::move(without.errors_);
    g = 0;
  }
}

}  // namespace

Partition partition_views(const Gram& gram, const ViewGraph& graph, const GroupRule& rule,
                          int threads) {
  std::vector<ViewGroup> grown = grow_groups(gram, graph, rule, threads);
  const std::size_t count = grown.size();
  auto chosen = maximise_boolean(description_gains(grown));
  if (chosen.empty()) {
    // Nothing is shorter than the views themselves: the largest group is as good as any.
    const auto largest = std::ranges::max_element(
        grown, {}, [](const ViewGroup& group) { return group.members.size(); });
    chosen = {static_cast<std::size_t>(largest - grown.begin())};
  }
  std::vector<ViewGroup> groups;
  groups.reserve(chosen.size());
  for (const std::size_t i : chosen) groups.push_back(std::move(grown[i]));

  Sharing sharing(gram, graph, rule);
  sharing.share_out(std::move(groups));
  sharing.refine();
  sharing.add_missing();
  sharing.drop_needless();
  return std::move(sharing).result(count);
}

}  // namespace sheen::fitting::multi_eigenspace
