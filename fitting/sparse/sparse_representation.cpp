// SPDX-License-Identifier: MIT
#include "fitting/sparse/sparse_representation.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/samples/change_list.h"
#include "fitting/samples/sample.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/predicted_error.h"
#include "fitting/sparse/sample_store.h"
#include "fitting/sparse/selection.h"
#include "fitting/unseen/fill_unseen.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <memory>

namespace sheen::fitting::sparse {
namespace {

/// What is known of a patch besides its model: 48 bytes and 12 per kept sample.
struct PatchState {
  SampleStore samples;
  std::uint32_t seen = 0;     ///< samples absorbed
  std::uint32_t look_at = 1;  ///< number of samples at which the patch is looked at anyway
  float expected_error = 0;   ///< of a new sample
  bool unsettled = false;     ///< touched since the last `finish`
};

/// Scratch of one thread.
struct Workspace {
  explicit Workspace(const Options& options) : selection(options) {}
  Selection selection;
  std::array<DirectedColour, kMaxStoredSamples> samples;

  std::span<const DirectedColour> read(const SampleStore& store) {
    for (std::size_t i = 0; i < store.size(); ++i) samples[i] = store[i];
    return {samples.data(), store.size()};
  }
};

struct Counts {
  std::size_t samples = 0;
  std::size_t fits = 0;
};

class SparseRepresentation final : public Representation {
 public:
  SparseRepresentation(const core::VertexNeighbours& neighbours, const Options& options,
                       int threads)
      : neighbours_(neighbours),
        options_(options),
        threads_(threads),
        states_(neighbours.vertex_count()),
        model_(neighbours.vertex_count()) {}

  const ModelUpdate& absorb(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return statistics_; }
  [[nodiscard]] std::optional<float> predicted_error(std::size_t patch_idx,
                                                     const Eigen::Vector2f& uv) const override;

 private:
  bool absorb_sample(std::size_t patch_idx, const Sample& sample, Workspace& workspace,
                     Counts& counts);
  bool take(std::size_t patch_idx, const SelectedModel& selected, Counts& counts);
  void settle();
  void fill();

  core::VertexNeighbours neighbours_;
  Options options_;
  int threads_;
  std::vector<PatchState> states_;
  LightFieldModel model_;
  FitStatistics statistics_;
  ChangeList changes_;
  ModelUpdate update_;
};

bool SparseRepresentation::take(std::size_t patch_idx, const SelectedModel& selected,
                                Counts& counts) {
  counts.fits += selected.fits;
  states_[patch_idx].expected_error = selected.expected_error;
  return model_.store(patch_idx, selected.model);
}

bool SparseRepresentation::absorb_sample(std::size_t patch_idx, const Sample& sample,
                                         Workspace& workspace, Counts& counts) {
  // Keep the sample.
  PatchState& state = states_[patch_idx];
  state.samples.add(sample, static_cast<std::size_t>(options_.max_samples));
  state.unsettled = true;
  ++state.seen;
  ++counts.samples;

  // Leave the patch alone while it predicts well.
  constexpr float surprise = 1.5f;
  const Eigen::Vector2f uv(static_cast<float>(sample.u), static_cast<float>(sample.v));
  const PatchModel model = model_.patch(patch_idx);
  if (state.seen < state.look_at) {
    const Eigen::Vector3f rgb = Eigen::Vector3d(sample.rgb.data()).cast<float>();
    const float squared_error = (evaluate(model, uv) - rgb).squaredNorm() / 3.0f;
    const float limit = surprise * state.expected_error;
    if (squared_error <= limit * limit) return false;
  } else {
    state.look_at = state.seen + std::max(1u, state.seen / 3);
  }

  // Improve it by one step.
  const bool changed =
      take(patch_idx, workspace.selection.step(workspace.read(state.samples), model, uv), counts);
  return model_.store_observed(patch_idx, true) || changed;
}

const ModelUpdate& SparseRepresentation::absorb(const core::SampleBatch& batch) {
  changes_.reset(batch.size());
  std::atomic<std::size_t> samples{0};
  std::atomic<std::size_t> fits{0};
  // Patches are independent and appear once: any split of the batch gives the same result.
  core::parallel_for(batch.size(), threads_, [&](std::size_t begin, std::size_t end) {
    const auto workspace = std::make_unique<Workspace>(options_);
    Counts counts;
    for (std::size_t i = begin; i < end; ++i) {
      assert(batch.patch[i] < states_.size() && (i == 0 || batch.patch[i - 1] < batch.patch[i]));
      const auto sample = usable_sample(batch, i);
      if (!sample) continue;
      changes_.mark(i, absorb_sample(batch.patch[i], *sample, *workspace, counts));
    }
    samples += counts.samples;
    fits += counts.fits;
  });
  statistics_.samples += samples;
  statistics_.patch_views += samples;
  statistics_.fits += fits;
  changes_.list([&](std::size_t i) { return batch.patch[i]; }, update_);
  return update_;
}

void SparseRepresentation::settle() {
  std::atomic<std::size_t> fits{0};
  core::parallel_for(states_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    const auto workspace = std::make_unique<Workspace>(options_);
    Counts counts;
    for (std::size_t patch = begin; patch < end; ++patch) {
      PatchState& state = states_[patch];
      if (!state.unsettled) continue;
      state.unsettled = false;
      changes_.mark(
          patch, take(patch, workspace->selection.choose(workspace->read(state.samples)), counts));
    }
    fits += counts.fits;
  });
  statistics_.fits += fits;
}

void SparseRepresentation::fill() {
  std::vector<Eigen::Vector3f> colours(states_.size());
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    colours[patch] = model_.mean_colour(patch);
  }
  fill_unseen(neighbours_, model_.observed(), colours);
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    if (model_.observed()[patch] != 0) continue;
    PatchModel constant;
    constant.coefficient[0] = colours[patch];
    changes_.mark(patch, model_.store(patch, constant));
  }
}

const ModelUpdate& SparseRepresentation::finish() {
  changes_.reset(states_.size());
  settle();
  fill();
  changes_.list([](std::size_t patch) { return static_cast<std::uint32_t>(patch); }, update_);
  return update_;
}

std::optional<float> SparseRepresentation::predicted_error(std::size_t patch_idx,
                                                           const Eigen::Vector2f& uv) const {
  const SampleStore& store = states_[patch_idx].samples;
  if (store.size() == 0) return std::nullopt;
  std::array<DirectedColour, kMaxStoredSamples> samples;
  for (std::size_t i = 0; i < store.size(); ++i) samples[i] = store[i];
  return sparse::predicted_error(model_.patch(patch_idx), {samples.data(), store.size()}, uv);
}

}  // namespace

std::unique_ptr<Representation> make_sparse_representation(const core::VertexNeighbours& neighbours,
                                                           const Options& options, int threads) {
  options.check();
  assert(threads >= 1);
  return std::make_unique<SparseRepresentation>(neighbours, options, threads);
}

}  // namespace sheen::fitting::sparse
