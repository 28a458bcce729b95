// SPDX-License-Identifier: MIT
// What the sparse fitter costs: a third of the patches are glossy, the camera walks round in a
// circle that every patch sees from another side.
#include "core/mesh/neighbours.h"
#include "core/samples/sample_batch.h"
#include "fitting/sparse/sparse_fitter.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>

namespace sheen::fitting {
namespace {

constexpr std::size_t kPatches = 31000;
// Part of the patches that a view sees, as measured on a closed mesh.
constexpr std::size_t kSeen = kPatches * 28 / 100;

std::unique_ptr<PatchFitter> make_sparse(int threads) {
  core::VertexNeighbours nobody;
  nobody.offsets.assign(kPatches + 1, 0);
  return sparse::make_sparse_fitter(nobody, {}, threads);
}

// A grey patch, every third with a highlight about 20 degrees wide at a place of its own.
float brightness(std::uint32_t patch, float u, float v) {
  if (patch % 3 != 0) return 0.4f;
  const auto turn = static_cast<float>(patch);
  const float du = u - 0.5f * std::cos(turn);
  const float dv = v - 0.5f * std::sin(turn);
  return 0.3f + 0.5f * std::exp(-(du * du + dv * dv) / 0.06f);
}

/// Views of a camera that moves by so much from one to the next.
class Walk {
 public:
  explicit Walk(float degrees_per_view)
      : step_(degrees_per_view * std::numbers::pi_v<float> / 180.0f) {}

  /// The next view: `kSeen` patches, others as the camera gets round; each sees it on a slightly
  /// wobbling arc of its own, from rim to rim.
  const core::SampleBatch& next() {
    std::uniform_real_distribution<float> noise(-0.017f, 0.017f);  // deviation .01
    batch_ = {};
    const float at = step_ * static_cast<float>(view_++);
    const float round = at / (2.0f * std::numbers::pi_v<float>);
    const auto first = static_cast<std::size_t>((round - std::floor(round)) * kPatches);
    for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
      const std::size_t behind = (patch + kPatches - first) % kPatches;
      if (behind >= kSeen) continue;
      const float along = 0.95f - 1.9f * static_cast<float>(behind) / static_cast<float>(kSeen);
      const float across = 0.3f * std::sin(std::floor(round) + static_cast<float>(patch));
      const float shade = brightness(patch, along, across);
      batch_.patch.push_back(patch);
      batch_.u.push_back(along);
      batch_.v.push_back(across);
      batch_.r.push_back(shade + noise(random_));
      batch_.g.push_back(shade + noise(random_));
      batch_.b.push_back(0.8f * shade + noise(random_));
    }
    return batch_;
  }

 private:
  float step_;
  int view_ = 0;
  std::mt19937 random_{1};
  core::SampleBatch batch_;
};

constexpr double kPerNanosecond = 1e-9;

// Goes on along a walk; the making of the samples is not measured.
void integrate(benchmark::State& state, PatchFitter& fitter, Walk& walk) {
  for (auto _ : state) {
    state.PauseTiming();
    const core::SampleBatch& batch = walk.next();
    state.ResumeTiming();
    fitter.integrate(batch);
  }
  state.counters["ns/sample"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kSeen * kPerNanosecond,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// 20 degrees a second at 30 frames a second, after a walk all round.
void integrate_steady(benchmark::State& state) {
  const auto fitter = make_sparse(1);
  Walk walk(0.67f);
  for (int view = 0; view < 600; ++view) fitter->integrate(walk.next());
  integrate(state, *fitter, walk);
}
BENCHMARK(integrate_steady)->Unit(benchmark::kMillisecond)->Iterations(200);

// The first time round, a view every 6 degrees: hardly anything merges, every patch grows.
void integrate_growing(benchmark::State& state) {
  const auto fitter = make_sparse(1);
  Walk walk(6.0f);
  integrate(state, *fitter, walk);
}
BENCHMARK(integrate_growing)->Unit(benchmark::kMillisecond)->Iterations(120);

std::unique_ptr<PatchFitter> taught(int views) {
  auto fitter = make_sparse(1);
  Walk walk(2.0f);
  for (int view = 0; view < views; ++view) fitter->integrate(walk.next());
  return fitter;
}

void finish(benchmark::State& state) {
  const auto fitter = taught(360);
  for (auto _ : state) fitter->finish();
  state.counters["us/patch"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kPatches * 1e-6,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(finish)->Unit(benchmark::kMillisecond)->Iterations(1);

// What a heat map asks for: once for every patch.
void predicted_error(benchmark::State& state) {
  const auto fitter = taught(360);
  for (auto _ : state) {
    float sum = 0;
    for (std::size_t patch = 0; patch < kPatches; ++patch) {
      sum += fitter->predicted_error(patch, {0.3f, -0.2f}).value_or(0.0f);
    }
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(predicted_error)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sheen::fitting
