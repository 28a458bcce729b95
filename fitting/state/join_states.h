// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/confidence/confidence.h"
#include "fitting/fitter.h"
#include "fitting/state/state_file.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace sheen::fitting {

struct WalkLevels;

/// A view of one of several states. Where they hold shares of the patches, as many of them as
/// there are shares, one after the other, are a view.
struct JoinedView {
  std::size_t state = 0;
  std::size_t view = 0;
};

/// Their views in the one order that all states have, whatever the order of `states`: joining is
/// associative and commutative to the last bit. Throws core::Error (bad_input) when they are not
/// fitted alike, not over one mesh, hold a view twice or not all shares of one.
std::vector<JoinedView> join(std::span<const std::unique_ptr<StateReader>> states);

/// Gets the number of views done.
using ViewsDone = std::function<void(std::size_t)>;

/// Gets a view and its samples, which it may change.
using JoinedViewAction = std::function<void(const StateView&, core::SampleBatch&)>;
/// Calls it for every view, one after the other, with the samples of all its shares.
void for_each_joined_view(std::span<const std::unique_ptr<StateReader>> states,
                          std::span<const JoinedView> views, const ViewsDone& done,
                          const JoinedViewAction& action);

/// A state of these views. `path` may be one of the states'.
void write_joined(const std::filesystem::path& path,
                  std::span<const std::unique_ptr<StateReader>> states,
                  std::span<const JoinedView> views, const ViewsDone& done);

/// The fit of these views, finished.
struct JoinedFit {
  std::unique_ptr<Fitter> fitter;
  SeenDirections seen;
};
/// Fits them one after the other, walks levelled as `levels` says: what a session of exactly these
/// frames gives. The states outlive the result.
JoinedFit fit_joined(std::span<const std::unique_ptr<StateReader>> states,
                     std::span<const JoinedView> views, const WalkLevels& levels, int threads,
                     const ViewsDone& done);

}  // namespace sheen::fitting
