// SPDX-License-Identifier: MIT
#include "fitting/state/level_walks.h"

#include "fitting/patch_fitter.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting {
namespace {

constexpr std::size_t kMostTrialPatches = 1024;
constexpr std::size_t kHoldOut = 8;  // every eighth view of a walk is kept for the trial
constexpr double kWorthIt = 0.99;    // of the error: less is no proof

bool is_of(const LevelledWalk& walk, const StateView& view) {
  return walk.session == view.session && walk.recording == view.recording;
}

Gain inverse(const Gain& gain) {
  return {1 / gain[0], 1 / gain[1], 1 / gain[2]};
}

/// Calls `action(walk, is_held_out, batch)` for every view.
template <typename Action>
void for_each_view(std::span<const std::unique_ptr<StateReader>> states,
                   std::span<const JoinedView> views, const ViewsDone& done, const Action& action) {
  std::vector<StateView> firsts;  // of each walk; its views follow each other
  std::size_t view_of_walk = 0;
  for_each_joined_view(states, views, done, [&](const StateView& view, core::SampleBatch& batch) {
    const bool goes_on = !firsts.empty() && firsts.back().session == view.session &&
                         firsts.back().recording == view.recording;
    if (!goes_on) {
      firsts.push_back(view);
      view_of_walk = 0;
    }
    action(firsts.size() - 1, view_of_walk++ % kHoldOut == kHoldOut / 2, batch);
  });
}

std::vector<LevelledWalk> walks_of(std::span<const std::unique_ptr<StateReader>> states,
                                   std::span<const JoinedView> views) {
  std::vector<LevelledWalk> walks;
  for (const JoinedView& joined : views) {
    if (states[joined.state]->header().share.number > 1) continue;  // counted with the first share
    const StateView& view = states[joined.state]->views()[joined.view];
    if (walks.empty() || !is_of(walks.back(), view)) {
      walks.push_back({view.session, view.recording});
    }
    ++walks.back().views;
  }
  return walks;
}

/// Fits of some of the patches, with and without gains, and how far both are off.
class Trial {
 public:
  Trial(const StateHeader& header, const std::vector<LevelledWalk>& walks, int threads)
      : walks_(walks),
        stride_(std::max<std::size_t>(
            1, (header.mesh.positions.size() + kMostTrialPatches - 1) / kMostTrialPatches)),
        as_is_(make(header, threads)),
        levelled_(make(header, threads)) {}

  void fit(std::size_t walk, core::SampleBatch& batch) {
    thin(batch);
    as_is_->integrate(batch);
    multiply_light(inverse(walks_[walk].gain), batch);
    levelled_->integrate(batch);
  }
  void finish() {
    as_is_->finish();
    levelled_->finish();
  }
  /// A held-out view, predicted in its own light.
  void predict(std::size_t walk, core::SampleBatch& batch) {
    thin(batch);
    predict(*as_is_, kNoGain, batch, square_as_is_);
    predict(*levelled_, walks_[walk].gain, batch, square_levelled_);
    values_ += 3 * batch.size();
  }
  [[nodiscard]] WalkLevels::Trial errors() const {
    const auto count = static_cast<double>(std::max<std::size_t>(1, values_));
    return {std::sqrt(square_as_is_ / count), std::sqrt(square_levelled_ / count)};
  }

 private:
  [[nodiscard]] std::unique_ptr<PatchFitter> make(const StateHeader& header, int threads) const {
    const std::size_t count = (header.mesh.positions.size() + stride_ - 1) / stride_;
    return make_isolated_patches(header.representation, count, header.options, threads);
  }

  /// Leaves every so many-th patch, numbered anew.
  void thin(core::SampleBatch& batch) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (batch.patch[i] % stride_ != 0) continue;
      batch.patch[kept] = static_cast<std::uint32_t>(batch.patch[i] / stride_);
      for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) {
        (*column)[kept] = (*column)[i];
      }
      ++kept;
    }
    batch.patch.resize(kept);
    for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) column->resize(kept);
  }

  static void predict(const PatchFitter& fitter, const Gain& gain, const core::SampleBatch& seen,
                      double& square) {
    core::SampleBatch batch = seen;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Eigen::Vector3f colour =
          fitter.light_field().evaluate(batch.patch[i], {batch.u[i], batch.v[i]}).colour();
      batch.r[i] = std::clamp(colour.x(), 0.0f, 1.0f);
      batch.g[i] = std::clamp(colour.y(), 0.0f, 1.0f);
      batch.b[i] = std::clamp(colour.z(), 0.0f, 1.0f);
    }
    multiply_light(gain, batch);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      square += std::pow(batch.r[i] - seen.r[i], 2) + std::pow(batch.g[i] - seen.g[i], 2) +
                std::pow(batch.b[i] - seen.b[i], 2);
    }
  }

  const std::vector<LevelledWalk>& walks_;
  std::size_t stride_;
  std::unique_ptr<PatchFitter> as_is_;
  std::unique_ptr<PatchFitter> levelled_;
  double square_as_is_ = 0;
  double square_levelled_ = 0;
  std::size_t values_ = 0;
};

}  // namespace

void WalkLevels::level(const StateView& view, core::SampleBatch& batch) const {
  if (!is_used) return;
  const auto walk =
      std::ranges::find_if(walks, [&view](const LevelledWalk& each) { return is_of(each, view); });
  if (walk != walks.end()) multiply_light(inverse(walk->gain), batch);
}

WalkLevels level_walks(std::span<const std::unique_ptr<StateReader>> states,
                       std::span<const JoinedView> views, int threads, const ViewsDone& done) {
  WalkLevels levels{walks_of(states, views), {}, false};
  if (levels.walks.size() < 2) return levels;
  const StateHeader& header = states.front()->header();

  // From the views that are not held out.
  WalkGains overlap(levels.walks.size(), header.mesh.positions.size());
  for_each_view(states, views, done, [&](std::size_t walk, bool is_held_out, auto& batch) {
    if (!is_held_out) overlap.add(walk, batch);
  });
  const auto gains = overlap.estimate();
  if (std::ranges::count(gains, kNoGain) == static_cast<std::ptrdiff_t>(gains.size())) {
    return levels;
  }
  for (std::size_t i = 0; i < gains.size(); ++i) levels.walks[i].gain = gains[i];

  // Do they help?
  Trial trial(header, levels.walks, threads);
  for_each_view(states, views, done, [&](std::size_t walk, bool is_held_out, auto& batch) {
    if (!is_held_out) trial.fit(walk, batch);
  });
  trial.finish();
  for_each_view(states, views, done, [&](std::size_t walk, bool is_held_out, auto& batch) {
    if (is_held_out) trial.predict(walk, batch);
  });
  levels.trial = trial.errors();
  levels.is_used = levels.trial->levelled < kWorthIt * levels.trial->as_is;
  return levels;
}

}  // namespace sheen::fitting
