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
constexpr double kBorderCost = 0.5;
/// A view drawn worse than so many tolerances asks for a group more.
constexpr double kWorst = 2;

class Sharing {
 public:
  Sharing(const Gram& gram, const ViewSphere& sphere, const GroupRule& rule)
      : gram_(gram), sphere_(sphere), rule_(rule) {}

  /// The views to the groups that draw them best.
  void share_out(std::vector<ViewGroup> groups);
  /// Views to groups that draw them well and have their neighbours, groups from their views.
  void refine();
  /// Adds groups where views are drawn badly; some views may stay so.
  void add_missing();

  [[nodiscard]] Partition result(std::size_t grown) && {
    return {std::move(groups_), std::move(owners_), grown};
  }

 private:
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(gram_.rows()); }
  [[nodiscard]] double border_cost(std::size_t view, std::uint32_t group_idx) const;
  void find_errors();
  void fit_groups();

  const Gram& gram_;
  const ViewSphere& sphere_;
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
  owners_.resize(count());
  for (std::size_t view = 0; view < count(); ++view) {
    Eigen::Index best = 0;
    errors_.row(static_cast<Eigen::Index>(view)).minCoeff(&best);
    owners_[view] = static_cast<std::uint32_t>(best);
  }
  fit_groups();
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
  const auto& neighbours = sphere_.neighbours(view);
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
        return errors_(static_cast<Eigen::Index>(view), group_idx) + border_cost(view, group_idx);
      };
      std::uint32_t best = owners_[view];
      for (const std::uint32_t next : sphere_.neighbours(view)) {
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
      const double error = errors_(static_cast<Eigen::Index>(i), owners_[i]);
      if (tried[i] != 0 || error <= most) continue;
      most = error;
      view = i;
    }
    if (view == count()) return;
    tried[view] = 1;
    // Of its group's views those go over that it draws better, the view itself at least.
    const ViewGroup more = grow_group(gram_, sphere_, rule_, static_cast<std::uint32_t>(view));
    const auto added = static_cast<std::uint32_t>(groups_.size());
    for (const std::uint32_t member : more.members) {
      if (member == view || more.residual(gram_, member) <
                                errors_(static_cast<Eigen::Index>(member), owners_[member])) {
        owners_[member] = added;
      }
    }
    groups_.push_back(more);
    fit_groups();
  }
}

}  // namespace

Partition partition_views(const Gram& gram, const ViewSphere& sphere, const GroupRule& rule,
                          int threads) {
  std::vector<ViewGroup> grown = grow_groups(gram, sphere, rule, threads);
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

  Sharing sharing(gram, sphere, rule);
  sharing.share_out(std::move(groups));
  sharing.refine();
  sharing.add_missing();
  return std::move(sharing).result(count);
}

}  // namespace sheen::fitting::multi_eigenspace
