// SPDX-License-Identifier: MIT
#include "fitting/sparse/sparse_fitter.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/samples/change_list.h"
#include "fitting/samples/sample.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/mean_over_views.h"
#include "fitting/sparse/noise_estimate.h"
#include "fitting/sparse/predicted_error.h"
#include "fitting/sparse/sample_store.h"
#include "fitting/sparse/selection.h"
#include "fitting/sparse/workspaces.h"
#include "fitting/unseen/fill_unseen.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <mutex>

namespace sheen::fitting::sparse {
namespace {

/// What may be spent on improving patches, per sample of a view; a step costs as many units as the
/// patch has kept samples, and as many again as kStepOverhead.
constexpr std::size_t kUnitsPerSample = 4;
constexpr std::size_t kStepOverhead = 16;
/// What any view may spend, as one of 8,192 samples: small objects leave the time for it.
constexpr std::size_t kFewestUnits = 32768;
/// Samples from which a patch may be more than one colour.
constexpr std::size_t kFewestToImprove = 4;
/// Spread of the colours to assume before the first fit.
constexpr float kSupposedSpread = 0.1f;

/// What is known of a patch besides its model: a cache line, and 12 bytes per kept sample.
struct alignas(64) PatchState {
  SampleStore samples;
  float expected_error = 0;  ///< of a new sample; 0 before the first fit
  float refit_priority = 0;  ///< sum of what predictions were off, squared, since the last fit
  float spread = kSupposedSpread;  ///< of the colours at the last fit
  std::uint8_t look_at = 0;  ///< number of kept samples at which the patch is looked at anyway
  bool unsettled = false;    ///< touched since the last `finish`
};
static_assert(sizeof(PatchState) == 64);

/// A patch that asks to be improved: position in the batch and how urgent it is.
struct Request {
  float refit_priority;
  std::uint32_t position;

  /// By urgency, then in order.
  [[nodiscard]] bool operator<(const Request& other) const {
    return refit_priority > other.refit_priority ||
           (refit_priority == other.refit_priority && position < other.position);
  }
};

class SparsePatches final : public SparseFitter {
 public:
  SparsePatches(const core::VertexNeighbours& neighbours, const Options& options, int threads)
      : neighbours_(neighbours),
        options_(options),
        threads_(threads),
        tolerance_(options.tolerance.value_or(kToleranceOfUnknownNoise)),
        states_(neighbours.vertex_count()),
        model_(neighbours.vertex_count()),
        workspaces_(options) {}

  const ModelUpdate& integrate_samples(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightFieldModel& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override {
    FitStatistics statistics = statistics_;
    statistics.tolerance = tolerance_;
    return statistics;
  }
  [[nodiscard]] std::optional<float> predicted_error(std::size_t patch_idx,
                                                     const Eigen::Vector2f& uv) const override;
  [[nodiscard]] Eigen::Vector3f mean_over_views(std::size_t patch_idx) const override;
  [[nodiscard]] std::vector<KeptSample> samples_of(std::size_t patch_idx) const override;

 private:
  void update_tolerance();
  bool integrate_sample(std::size_t patch_idx, const DirectedColour& sample, NoiseEstimate& noise);
  void keep_samples(const core::SampleBatch& batch);
  void collect_requests(const core::SampleBatch& batch);
  void improve(const core::SampleBatch& batch);
  bool take(std::size_t patch_idx, const SelectedModel& selected,
            std::span<const DirectedColour> samples);
  void settle();
  void fill();

  core::VertexNeighbours neighbours_;
  Options options_;
  int threads_;
  float tolerance_;
  std::vector<PatchState> states_;
  SamplePool pool_;
  LightFieldModel model_;
  NoiseEstimate noise_;
  Workspaces workspaces_;
  FitStatistics statistics_;
  std::vector<Request> requests_;
  ChangeList changes_;
  ModelUpdate update_;
};

// Noise is no reason for a term: two deviations keep out all but the rarest.
void SparsePatches::update_tolerance() {
  constexpr float deviations = 2.0f;
  constexpr float least = 0.01f;  // of the best camera poses and meshes are not exact either
  constexpr float most = 0.05f;
  if (options_.tolerance) return;
  if (const auto noise = noise_.deviation()) {
    tolerance_ = std::clamp(deviations * *noise, least, most);
  }
}

bool SparsePatches::take(std::size_t patch_idx, const SelectedModel& selected,
                         std::span<const DirectedColour> samples) {
  PatchState& state = states_[patch_idx];
  state.expected_error = selected.expected_error;
  state.refit_priority = 0;
  state.spread = colour_spread(samples);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    state.samples.set_normalised_residual(i, selected.left_out_residuals[i], pool_);
  }
  return model_.store(patch_idx, selected.model);
}

// Most samples of a slowly moving camera are averaged into a kept one and end here. Returns whether
// the model changed.
bool SparsePatches::integrate_sample(std::size_t patch_idx, const DirectedColour& sample,
                                     NoiseEstimate& noise) {
  // Keep the sample.
  constexpr float saturated = 254.0f / 255.0f;
  PatchState& state = states_[patch_idx];
  state.unsettled = true;
  const SampleStore::Arrival arrival =
      state.samples.add(sample, static_cast<std::size_t>(options_.max_samples), pool_);
  if (arrival.merged) {
    if (sample.rgb.maxCoeff() < saturated) noise.add(arrival.disagreement);
    return false;
  }

  // Compare with the prediction; a patch of one colour follows the mean.
  constexpr float normalised_residual = 1.5f;
  const bool first = state.samples.size() == 1;
  const Eigen::Vector3f predicted = first ? sample.rgb : model_.colour(patch_idx, sample.uv);
  const float error = size_of(predicted - sample.rgb);
  state.samples.set_normalised_residual(arrival.idx, error, pool_);
  const float limit = normalised_residual * std::max(state.expected_error, tolerance_);
  state.refit_priority += std::max(0.0f, error * error - limit * limit);
  if (state.samples.size() >= state.look_at) {
    state.refit_priority += tolerance_ * tolerance_;
    const std::size_t third = std::max<std::size_t>(1, state.samples.size() / 3);
    state.look_at = static_cast<std::uint8_t>(state.samples.size() + third);
  }
  const bool changed = model_.follow_mean(patch_idx, sample.rgb, state.samples.size());
  return model_.store_observed(patch_idx, true) || changed;
}

void SparsePatches::keep_samples(const core::SampleBatch& batch) {
  pool_.reserve(batch.size());
  std::mutex mutex;
  // Patches are independent and appear once: any split of the batch gives the same result.
  core::parallel_for(batch.size(), threads_, [&](std::size_t begin, std::size_t end) {
    NoiseEstimate noise;
    std::size_t samples = 0;
    for (std::size_t i = begin; i < end; ++i) {
      assert(batch.patch[i] < states_.size() && (i == 0 || batch.patch[i - 1] < batch.patch[i]));
      const auto sample = usable_sample(batch, i);
      if (!sample) continue;
      const DirectedColour kept{Eigen::Vector2d(sample->u, sample->v).cast<float>(),
                                Eigen::Vector3d(sample->rgb.data()).cast<float>()};
      changes_.mark(i, integrate_sample(batch.patch[i], kept, noise));
      ++samples;
    }
    const std::lock_guard lock(mutex);
    noise_.add(noise);
    statistics_.samples += samples;
    statistics_.patch_views += samples;
  });
}

// The most urgent of the view's patches, as many as the budget allows: a count of work and not a
// time, so that results do not depend on the machine. The others keep their refit priority and ask
// again when they are seen again, or wait for `finish`.
void SparsePatches::collect_requests(const core::SampleBatch& batch) {
  requests_.clear();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const PatchState& state = states_[batch.patch[i]];
    if (!(state.refit_priority > 0.0f) || state.samples.size() < kFewestToImprove) continue;
    requests_.push_back({state.refit_priority, static_cast<std::uint32_t>(i)});
  }
  // Sort no more of them than can be paid for.
  std::size_t units = std::max(kFewestUnits, batch.size() * kUnitsPerSample);
  const std::size_t most = units / (kStepOverhead + kFewestToImprove);
  const auto end =
      requests_.begin() + static_cast<std::ptrdiff_t>(std::min(most, requests_.size()));
  std::partial_sort(requests_.begin(), end, requests_.end());
  std::size_t granted = 0;
  for (auto request = requests_.begin(); request != end; ++request, ++granted) {
    const std::size_t cost = kStepOverhead + states_[batch.patch[request->position]].samples.size();
    if (cost > units) break;
    units -= cost;
  }
  requests_.resize(granted);
}

void SparsePatches::improve(const core::SampleBatch& batch) {
  constexpr std::size_t steps_worth_a_thread = 64;
  std::mutex mutex;
  core::parallel_for(
      requests_.size(), threads_,
      [&](std::size_t begin, std::size_t end) {
        std::size_t fits = 0;
        workspaces_.with_one([&](Workspace& workspace) {
          workspace.selection.set_tolerance(tolerance_);
          for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t position = requests_[i].position;
            const std::uint32_t patch = batch.patch[position];
            const auto samples = states_[patch].samples.read(pool_, workspace.samples);
            const SelectedModel stepped = workspace.selection.step(
                samples, model_.patch(patch), {batch.u[position], batch.v[position]});
            changes_.mark(position, take(patch, stepped, samples));
            fits += stepped.fits;
          }
        });
        const std::lock_guard lock(mutex);
        statistics_.fits += fits;
      },
      steps_worth_a_thread);
}

const ModelUpdate& SparsePatches::integrate_samples(const core::SampleBatch& batch) {
  changes_.reset(batch.size());
  keep_samples(batch);
  update_tolerance();
  collect_requests(batch);
  improve(batch);
  changes_.list([&](std::size_t i) { return batch.patch[i]; }, update_);
  return update_;
}

void SparsePatches::settle() {
  std::mutex mutex;
  core::parallel_for(states_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    std::size_t fits = 0;
    workspaces_.with_one([&](Workspace& workspace) {
      workspace.selection.set_tolerance(tolerance_);
      for (std::size_t patch = begin; patch < end; ++patch) {
        PatchState& state = states_[patch];
        if (!state.unsettled) continue;
        state.unsettled = false;
        const auto samples = state.samples.read(pool_, workspace.samples);
        const SelectedModel chosen = workspace.selection.choose(samples);
        changes_.mark(patch, take(patch, chosen, samples));
        fits += chosen.fits;
      }
    });
    const std::lock_guard lock(mutex);
    statistics_.fits += fits;
  });
}

void SparsePatches::fill() {
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

const ModelUpdate& SparsePatches::finish() {
  changes_.reset(states_.size());
  settle();
  fill();
  changes_.list([](std::size_t patch) { return static_cast<std::uint32_t>(patch); }, update_);
  return update_;
}

std::optional<float> SparsePatches::predicted_error(std::size_t patch_idx,
                                                    const Eigen::Vector2f& uv) const {
  const PatchState& state = states_[patch_idx];
  if (state.samples.size() == 0) return std::nullopt;
  return sparse::predicted_error(state.samples, pool_, state.spread, uv,
                                 model_.colour(patch_idx, uv));
}

Eigen::Vector3f SparsePatches::mean_over_views(std::size_t patch_idx) const {
  return sparse::mean_over_views(model_.patch(patch_idx), states_[patch_idx].samples, pool_);
}

std::vector<KeptSample> SparsePatches::samples_of(std::size_t patch_idx) const {
  const SampleStore& samples = states_[patch_idx].samples;
  std::vector<KeptSample> kept(samples.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const DirectedColour sample = samples.at(i, pool_);
    kept[i] = {sample, samples.count(i, pool_) * std::max(0.0f, 1.0f - sample.uv.squaredNorm())};
  }
  return kept;
}

}  // namespace

std::unique_ptr<SparseFitter> make_sparse_fitter(const core::VertexNeighbours& neighbours,
                                                 const Options& options, int threads) {
  options.check();
  assert(threads >= 1);
  return std::make_unique<SparsePatches>(neighbours, options, threads);
}

}  // namespace sheen::fitting::sparse
