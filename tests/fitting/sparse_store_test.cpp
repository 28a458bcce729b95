// SPDX-License-Identifier: MIT
#include "fitting/sparse/noise_estimate.h"
#include "fitting/sparse/sample_store.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace sheen::fitting::sparse {
namespace {

using testing::scattered;

/// A store with a pool of its own.
struct Kept {
  SamplePool pool;
  SampleStore store;

  SampleStore::Arrival add(const Eigen::Vector2d& uv, const Eigen::Vector3f& rgb,
                           std::size_t max_samples) {
    pool.reserve(1);
    return store.add({uv.cast<float>(), rgb}, max_samples, pool);
  }
  [[nodiscard]] DirectedColour operator[](std::size_t idx) const { return store.at(idx, pool); }
};

TEST(SampleStore, KeepsTheExtremesWhenFull) {
  // Samples crowd round the centre; the four at the rim come first and must survive unmerged.
  Kept kept;
  const std::array<Eigen::Vector2d, 4> rim{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (const Eigen::Vector2d& x : rim) kept.add(x, Eigen::Vector3f::Ones(), 16);
  for (const Eigen::Vector2d& x : scattered(500, 10)) {
    kept.add(0.3 * x, Eigen::Vector3f::Zero(), 16);
  }
  ASSERT_LE(kept.store.size(), 16u);
  ASSERT_GT(kept.store.size(), 8u);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    EXPECT_LT((kept[i].uv - rim[i].cast<float>()).norm(), 1e-4f);
    EXPECT_NEAR(kept[i].rgb.x(), 1.0f, 1e-4f);
  }
}

TEST(SampleStore, StaysSpreadOutAndBounded) {
  // What is kept when full covers the disc: every direction has a kept sample nearby. 96 discs of
  // radius r cover at least the area of the unit disc if r = 1 / sqrt(96) = 0.102 and they do not
  // overlap; a greedy choice needs at most twice that radius, its spacing.
  Kept kept;
  const auto directions = scattered(4000, 11);
  for (const Eigen::Vector2d& x : directions) {
    kept.add(x, Eigen::Vector3f::Zero(), 96);
    ASSERT_LE(kept.store.size(), 96u);
  }
  std::array<float, kMaxStoredSamples> squared;
  for (const Eigen::Vector2d& x : directions) {
    const std::size_t nearest = kept.store.distances(x.cast<float>(), kept.pool, squared);
    EXPECT_LT(std::sqrt(squared[nearest]), 0.25f);
  }
}

TEST(SampleStore, SlowCameraMerges) {
  // Steps of 0.1 degrees, 0.0017 on the disc, are a tenth of the first spacing, 0.02: of 100
  // samples over 0.17 at most 1 + 0.17 / 0.02 = 9 are kept.
  Kept kept;
  for (int i = 0; i < 100; ++i) kept.add({0.0017 * i, 0.2}, Eigen::Vector3f::Zero(), 96);
  EXPECT_LE(kept.store.size(), 17u);
  EXPECT_GE(kept.store.size(), 4u);
}

TEST(SampleStore, MergingAveragesColours) {
  // 2 places, then 100 samples of alternating colour at one of them: their mean is 0.5.
  Kept kept;
  kept.add({0.9, 0}, Eigen::Vector3f::Zero(), 2);
  for (int i = 0; i < 100; ++i) kept.add({-0.9, 0}, {i % 2 == 0 ? 0.4f : 0.6f, 0, 0}, 2);
  ASSERT_EQ(kept.store.size(), 2u);
  // Each merge rounds to 1/65534; the sum of 99 roundings weighted by 1/count stays below 1e-3.
  EXPECT_NEAR(kept[1].rgb.x(), 0.5f, 1e-3f);
}

TEST(SampleStore, NormalisedResidualComesBackWithinItsSteps) {
  Kept kept;
  kept.add({0, 0}, Eigen::Vector3f::Zero(), 8);
  for (const float normalised_residual : {0.0002f, 0.004f, 0.05f, 0.9f}) {
    kept.store.set_normalised_residual(0, normalised_residual, kept.pool);
    // 17 steps a factor of two: half a step is 2 %.
    EXPECT_NEAR(kept.store.normalised_residual(0, kept.pool) / normalised_residual, 1.0f, 0.025f);
  }
}

TEST(NoiseEstimate, FindsTheDeviationInSpiteOfOutliers) {
  constexpr unsigned seed = 12;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.0f, 0.013f);
  Kept kept;
  NoiseEstimate noise;
  EXPECT_FALSE(noise.deviation().has_value());
  for (int i = 0; i < 20000; ++i) {
    // Every tenth sample shows something else.
    const Eigen::Vector3f rgb =
        i % 10 == 0
            ? Eigen::Vector3f(0.9f, 0.1f, 0.2f)
            : Eigen::Vector3f(0.5f + normal(random), 0.5f + normal(random), 0.5f + normal(random));
    // Two samples each time, so that no mean is spoilt for long.
    if (i % 2 == 0) kept.store = {};
    const auto arrival = kept.add({0.1, 0.1}, rgb, 8);
    if (arrival.merged) noise.add(arrival.disagreement);
  }
  // A bin is 8 % wide; a tenth of outliers moves the median of the rest from its 50th to its 56th
  // percentile, 7 % up.
  ASSERT_TRUE(noise.deviation().has_value());
  EXPECT_NEAR(*noise.deviation() / 0.013f, 1.05f, 0.12f);
}

TEST(NoiseEstimate, PartsAddUpInAnyOrder) {
  NoiseEstimate whole, first, second;
  for (int i = 1; i <= 3000; ++i) {
    const float difference = 0.00001f * static_cast<float>(i);
    whole.add(difference);
    (i % 3 == 0 ? first : second).add(difference);
  }
  second.add(first);
  EXPECT_EQ(whole.deviation(), second.deviation());
}

}  // namespace
}  // namespace sheen::fitting::sparse
