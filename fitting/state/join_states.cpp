// SPDX-License-Identifier: MIT
#include "fitting/state/join_states.h"

#include "core/diagnostics/error.h"
#include "fitting/descriptor.h"
#include "fitting/patch_fitter.h"
#include "fitting/state/level_walks.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace sheen::fitting {
namespace {

void check_alike(const StateReader& first, const StateReader& other) {
  const StateHeader& a = first.header();
  const StateHeader& b = other.header();
  if (a.representation != b.representation || a.options != b.options) {
    throw core::bad_input(other.path(),
                          "is fitted as " + b.representation + " with other settings than " +
                              first.path().string() + " (" + a.representation + ")",
                          "fit both with the same options");
  }
  if (a.mesh.positions != b.mesh.positions || a.mesh.normals != b.mesh.normals ||
      a.mesh.triangles != b.mesh.triangles || a.mesh.offset != b.mesh.offset) {
    throw core::bad_input(other.path(), "lies on another mesh than " + first.path().string(),
                          "use one mesh file for all sessions of an object");
  }
}

const StateView& name_of(std::span<const std::unique_ptr<StateReader>> states,
                         const JoinedView& view) {
  return states[view.state]->views()[view.view];
}

/// Every view once, in all of its shares; they are sorted.
void check_complete(std::span<const std::unique_ptr<StateReader>> states,
                    std::span<const JoinedView> views) {
  const auto share_of = [&](const JoinedView& view) { return states[view.state]->header().share; };
  for (std::size_t i = 0; i < views.size(); ++i) {
    const StateReader& state = *states[views[i].state];
    const StateView& name = name_of(states, views[i]);
    const core::PatchShare share = share_of(views[i]);
    const bool goes_on = i > 0 && name_of(states, views[i - 1]) == name;
    if (goes_on && (share_of(views[i - 1]) == share || share_of(views[i - 1]).of != share.of)) {
      throw core::bad_input(state.path(),
                            "holds frame " + std::to_string(name.frame) + " of " + name.session +
                                ", as does " + states[views[i - 1].state]->path().string(),
                            "give every recording once, or sheen forget it in one of them");
    }
    const bool is_next = share.number == (goes_on ? share_of(views[i - 1]).number + 1 : 1);
    const bool ends = i + 1 == views.size() || name_of(states, views[i + 1]) != name;
    if (!is_next || (ends && share.number != share.of)) {
      const std::uint32_t missing = is_next ? share.number + 1 : share.number - 1;
      throw core::bad_input(state.path(),
                            "holds part " + std::to_string(share.number) + " of " +
                                std::to_string(share.of) + " of frame " +
                                std::to_string(name.frame) + " of " + name.session + ", part " +
                                std::to_string(missing) + " is missing",
                            "give sheen merge the states of all parts at once");
    }
  }
}

void append(const core::SampleBatch& from, core::SampleBatch& to) {
  const auto add = [](const auto& column, auto& longer) {
    longer.insert(longer.end(), column.begin(), column.end());
  };
  add(from.patch, to.patch);
  add(from.u, to.u);
  add(from.v, to.v);
  add(from.r, to.r);
  add(from.g, to.g);
  add(from.b, to.b);
}

}  // namespace

void for_each_joined_view(std::span<const std::unique_ptr<StateReader>> states,
                          std::span<const JoinedView> views, const ViewsDone& done,
                          const JoinedViewAction& action) {
  core::SampleBatch share;
  core::SampleBatch batch;
  std::size_t count = 0;
  for (const JoinedView& view : views) {
    StateReader& state = *states[view.state];
    const core::PatchShare part = state.header().share;
    if (part.number == 1) batch.clear();
    state.read(view.view, share);
    append(share, batch);
    ++count;
    if (part.number < part.of) continue;
    action(name_of(states, view), batch);
    done(count);
  }
}

std::vector<JoinedView> join(std::span<const std::unique_ptr<StateReader>> states) {
  for (const auto& state : states) check_alike(*states.front(), *state);
  std::vector<JoinedView> joined;
  for (std::size_t s = 0; s < states.size(); ++s) {
    for (std::size_t v = 0; v < states[s]->views().size(); ++v) joined.push_back({s, v});
  }
  std::ranges::sort(joined, {}, [&](const JoinedView& view) {
    return std::pair(name_of(states, view), states[view.state]->header().share.number);
  });
  check_complete(states, joined);
  return joined;
}

void write_joined(const std::filesystem::path& path,
                  std::span<const std::unique_ptr<StateReader>> states,
                  std::span<const JoinedView> views, const ViewsDone& done) {
  StateHeader header = states.front()->header();
  header.share = {};
  StateWriter writer(path, header);
  for_each_joined_view(
      states, views, done,
      [&](const StateView& name, const core::SampleBatch& batch) { writer.append(name, batch); });
  writer.commit();
}

JoinedFit fit_joined(std::span<const std::unique_ptr<StateReader>> states,
                     std::span<const JoinedView> views, const WalkLevels& levels, int threads,
                     const ViewsDone& done) {
  const StateHeader& header = states.front()->header();
  JoinedFit fit{make_fitter(header.representation, header.mesh, header.options, threads),
                SeenDirections(header.mesh.positions.size())};
  auto* const patches = dynamic_cast<PatchFitter*>(fit.fitter.get());
  if (patches == nullptr) {
    throw core::bad_input(states.front()->path(),
                          "is fitted as " + header.representation + ", which takes images",
                          "choose a representation that takes samples");
  }
  for_each_joined_view(states, views, done, [&](const StateView& name, core::SampleBatch& batch) {
    levels.level(name, batch);
    note_seen(batch, fit.seen);
    patches->integrate(batch);
  });
  fit.fitter->finish();
  return fit;
}

}  // namespace sheen::fitting
