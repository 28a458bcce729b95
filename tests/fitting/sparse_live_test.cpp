// SPDX-License-Identifier: MIT
// What the sparse fitter does while views arrive, before `finish`.
#include "fitting/sparse/sparse_fitter.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace sheen::fitting::sparse {
namespace {

using testing::add_sample;
using testing::colour_of;
using testing::disc_grid;
using testing::isolated;
using testing::one_sample;
using testing::scattered;

std::unique_ptr<PatchFitter> make_live(std::size_t patches, const Options& options = {}) {
  return make_sparse_fitter(isolated(patches), options, 1);
}

Eigen::Vector3d broad_highlight(double u, double v) {
  const double squared = (u - 0.3) * (u - 0.3) + (v + 0.2) * (v + 0.2);
  return Eigen::Vector3d(0.3, 0.25, 0.2) +
         Eigen::Vector3d::Constant(0.5 * std::exp(-squared / 0.1));
}

TEST(SparseLive, FirstViewIsShownAtOnce) {
  const auto fitter = make_live(2);
  fitter->integrate(one_sample(0, {0.2, 0.1}, {0.5, 0.25, 0.75}));
  EXPECT_EQ(colour_of(fitter->light_field(), 0, {0, 0}), Eigen::Vector3f(0.5f, 0.25f, 0.75f));
  EXPECT_EQ(fitter->light_field().observed()[0], 1);
  EXPECT_EQ(fitter->light_field().observed()[1], 0);
}

TEST(SparseLive, HighlightIsFollowedBeforeTheEnd) {
  const auto fitter = make_live(1);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const auto directions = scattered(96, 1);
  for (const Eigen::Vector2d& x : directions) {
    fitter->integrate(one_sample(0, x, broad_highlight(x.x(), x.y())));
    mean += broad_highlight(x.x(), x.y()) / 96.0;
  }
  double squared = 0;
  double squared_of_mean = 0;
  for (const Eigen::Vector2f& x : disc_grid()) {
    const Eigen::Vector3d truth =
        broad_highlight(static_cast<double>(x.x()), static_cast<double>(x.y()));
    squared += (colour_of(fitter->light_field(), 0, x).cast<double>() - truth).squaredNorm();
    squared_of_mean += (mean - truth).squaredNorm();
  }
  // A tenth of the variance is 10 dB.
  EXPECT_LT(squared, 0.1 * squared_of_mean);
}

// All patches are badly predicted for every view. A patch of four samples or more costs at least 20
// units of a view's work, and a step solves at most five systems: the patch as it is, with a linear
// base, with a RBF more, with one less, and the outcome. A view may spend four units a sample, and
// 32768 in any case: 4800 patches 1638 steps, where four units a sample were 960 steps and so 4800
// systems at most, 12000 patches 2400.
TEST(SparseLive, WorkOfAViewIsBounded) {
  for (const auto& [patches, most_fits] : {std::pair{4800u, 8190u}, std::pair{12000u, 12000u}}) {
    const auto fitter = make_live(patches);
    std::mt19937 random(2);
    std::size_t before = 0;
    std::size_t most_found = 0;
    for (const Eigen::Vector2d& x : scattered(12, 3)) {
      core::SampleBatch batch;
      for (std::uint32_t patch = 0; patch < patches; ++patch) {
        const double value = static_cast<double>(random()) / 4294967295.0;
        add_sample(batch, patch, x, Eigen::Vector3d::Constant(value));
      }
      fitter->integrate(batch);
      const std::size_t fits = fitter->statistics().fits;
      most_found = std::max(most_found, fits - before);
      before = fits;
    }
    EXPECT_LE(most_found, most_fits);
    EXPECT_GT(most_found, 4800u);
  }
}

TEST(SparseLive, ToleranceIsTwiceTheNoiseUnlessGiven) {
  // Three channels of independent noise .01, seen from the same few directions again and again.
  constexpr unsigned seed = 4;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.01);
  constexpr std::uint32_t patches = 100;
  const auto estimated = make_live(patches);
  const auto given = make_live(patches, {.tolerance = 0.03f});
  EXPECT_EQ(estimated->statistics().tolerance, kToleranceOfUnknownNoise);
  for (int view = 0; view < 30; ++view) {
    core::SampleBatch batch;
    for (std::uint32_t patch = 0; patch < patches; ++patch) {
      add_sample(batch, patch, {0.001 * view, 0.3},
                 {0.5 + noise(random), 0.5 + noise(random), 0.5 + noise(random)});
    }
    estimated->integrate(batch);
    given->integrate(batch);
  }
  // 2800 differences: the median is off by some 2 %, a bin is 8 % wide.
  EXPECT_NEAR(estimated->statistics().tolerance.value_or(0.0f), 0.02f, 0.002f);
  EXPECT_EQ(given->statistics().tolerance, 0.03f);
}

}  // namespace
}  // namespace sheen::fitting::sparse
