// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/node_tree.h"
#include "fitting/iwls/patch_fit.h"

#include <bitset>
#include <utility>
#include <vector>

namespace sheen::fitting::iwls {

/// The paper's hierarchical construction (section 3.3.2): one node over the whole disc, split into
/// four with smaller supports where samples gather (eq. 9). A sample enters every leaf whose
/// support covers it. Leaves above the finest level are copied down to the centres they stand for.
///
/// No sample is stored: sums run at all nodes of all levels from the start, so a node that a split
/// brings to life already knows its samples. A node is split when it and all its ancestors hold
/// more samples than the limit - a function of the counts, so the tree itself needs no storage and
/// nothing depends on the order of the views.
template <std::size_t kTerms>
class Quadtree {
 public:
  Quadtree(FitSettings settings, std::size_t patch_count)
      : settings_(std::move(settings)),
        tree_(settings_.layout),
        sums_(patch_count * tree_.nodes().size()) {}

  FitOutcome absorb(std::size_t patch_idx, const Sample& sample, const Rgb& mean,
                    LightFieldModel& model);
  FitOutcome solve(std::size_t patch_idx, const Rgb& mean, LightFieldModel& model) const;

  static constexpr bool kSolvesAtOnce = true;

 private:
  static constexpr std::size_t kMaxNodes = 1 + 4 + 16 + 64;
  using NodeSet = std::bitset<kMaxNodes>;

  // One walk over the tree of a patch.
  struct Walk {
    std::size_t patch_idx;
    const NormalEquations<kTerms>* sums;
    LightFieldModel& model;
    NodeSet covering;  // nodes whose sums just changed
    FitOutcome outcome{};
  };

  void visit(Walk& walk, std::size_t node, const Rgb& prior, bool refit_all) const;
  void refit_leaf(Walk& walk, std::size_t leaf, const Rgb& prior) const;
  [[nodiscard]] Rgb passed_on(const NormalEquations<kTerms>& sums, const Rgb& prior) const;

  FitSettings settings_;
  NodeTree tree_;
  std::vector<NormalEquations<kTerms>> sums_;  // [patch][node]
};

template <std::size_t kTerms>
FitOutcome Quadtree<kTerms>::absorb(std::size_t patch_idx, const Sample& sample, const Rgb& mean,
                                    LightFieldModel& model) {
  const std::size_t node_count = tree_.nodes().size();
  NormalEquations<kTerms>* sums = sums_.data() + patch_idx * node_count;
  Walk walk{patch_idx, sums, model, {}};
  for (std::size_t node = 0; node < node_count; ++node) {
    if (add_if_covered(tree_.nodes()[node], sample, sums[node])) walk.covering.set(node);
  }
  visit(walk, 0, mean, false);
  return walk.outcome;
}

template <std::size_t kTerms>
FitOutcome Quadtree<kTerms>::solve(std::size_t patch_idx, const Rgb& mean,
                                   LightFieldModel& model) const {
  Walk walk{patch_idx, sums_.data() + patch_idx * tree_.nodes().size(), model, {}};
  visit(walk, 0, mean, true);
  return walk.outcome;
}

template <std::size_t kTerms>
void Quadtree<kTerms>::visit(Walk& walk, std::size_t node, const Rgb& prior, bool refit_all) const {
  const NormalEquations<kTerms>& sums = walk.sums[node];
  const bool covering = walk.covering[node];
  const bool split = !tree_.is_finest(node) && sums.count > settings_.refine_above;
  if (split) {
    // A node that crossed the limit just now hands over to children that never spoke before.
    const bool new_split = covering && sums.count <= settings_.refine_above + 1;
    const Rgb own = passed_on(sums, prior);
    for (const std::uint32_t child : tree_.children(node)) {
      visit(walk, child, own, refit_all || new_split);
    }
  } else if (refit_all || covering || sums.count == 0) {
    refit_leaf(walk, node, prior);
  }
}

// What a split node knows about the value below it: its weighted mean, itself leaning on what it
// was told. Cheaper than its own fit, and as good as a prior that counts for a tenth of a sample.
template <std::size_t kTerms>
Rgb Quadtree<kTerms>::passed_on(const NormalEquations<kTerms>& sums, const Rgb& prior) const {
  const double pull = settings_.rule.ridge.value;
  const double inverse = 1.0 / (sums.weight() + pull);
  Rgb value;
  for (std::size_t i = 0; i < 3; ++i) value[i] = (sums.g[i] + pull * prior[i]) * inverse;
  return value;
}

template <std::size_t kTerms>
void Quadtree<kTerms>::refit_leaf(Walk& walk, std::size_t leaf, const Rgb& prior) const {
  // Without a ridge a leaf that holds nothing keeps its parent's polynomial, as if it were not
  // split.
  std::size_t source = leaf;
  if (settings_.rule.faithful) {
    while (source != 0 && walk.sums[source].count == 0) source = tree_.parent(source);
  }
  const Polynomial<kTerms> fitted = fit(walk.sums[source], prior, settings_.rule);
  walk.outcome.fits += walk.sums[leaf].count > 0 ? 1 : 0;
  // Copy it down.
  for (const std::uint32_t center : tree_.finest_below(leaf)) {
    const NodeTree::Copy copy = tree_.copy_to(source, center);
    walk.outcome.changed |=
        walk.model.store(walk.patch_idx, center,
                         re_expanded<kTerms>(fitted, copy.shift_x, copy.shift_y, copy.scale));
  }
}

}  // namespace sheen::fitting::iwls
