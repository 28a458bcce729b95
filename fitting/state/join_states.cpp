// SPDX-License-Identifier: MIT
#include "fitting/state/join_states.h"

#include "core/diagnostics/error.h"
#include "fitting/descriptor.h"
#include "fitting/patch_fitter.h"

#include <algorithm>

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

}  // namespace

std::vector<JoinedView> join(std::span<const std::unique_ptr<StateReader>> states) {
  for (const auto& state : states) check_alike(*states.front(), *state);
  std::vector<JoinedView> joined;
  for (std::size_t s = 0; s < states.size(); ++s) {
    for (std::size_t v = 0; v < states[s]->views().size(); ++v) joined.push_back({s, v});
  }
  const auto key = [&](const JoinedView& view) -> const StateView& {
    return states[view.state]->views()[view.view];
  };
  std::ranges::sort(joined, {}, key);
  const auto twice = std::ranges::adjacent_find(joined, {}, key);
  if (twice != joined.end()) {
    const StateView& view = key(*twice);
    throw core::bad_input(states[std::next(twice)->state]->path(),
                          "holds frame " + std::to_string(view.frame) + " of " + view.session +
                              ", as does " + states[twice->state]->path().string(),
                          "give every recording once, or sheen forget it in one of them");
  }
  return joined;
}

void write_joined(const std::filesystem::path& path,
                  std::span<const std::unique_ptr<StateReader>> states,
                  std::span<const JoinedView> views, const ViewsDone& done) {
  StateWriter writer(path, states.front()->header());
  core::SampleBatch batch;
  std::size_t count = 0;
  for (const JoinedView& view : views) {
    states[view.state]->read(view.view, batch);
    writer.append(states[view.state]->views()[view.view], batch);
    done(++count);
  }
  writer.commit();
}

JoinedFit fit_joined(std::span<const std::unique_ptr<StateReader>> states,
                     std::span<const JoinedView> views, int threads, const ViewsDone& done) {
  const StateHeader& header = states.front()->header();
  JoinedFit fit{make_fitter(header.representation, header.mesh, header.options, threads),
                SeenDirections(header.mesh.positions.size())};
  auto* const patches = dynamic_cast<PatchFitter*>(fit.fitter.get());
  if (patches == nullptr) {
    throw core::bad_input(states.front()->path(),
                          "is fitted as " + header.representation + ", which takes images",
                          "choose a representation that takes samples");
  }
  core::SampleBatch batch;
  std::size_t count = 0;
  for (const JoinedView& view : views) {
    states[view.state]->read(view.view, batch);
    note_seen(batch, fit.seen);
    patches->integrate(batch);
    done(++count);
  }
  fit.fitter->finish();
  return fit;
}

}  // namespace sheen::fitting
