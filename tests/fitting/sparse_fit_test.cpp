// SPDX-License-Identifier: MIT
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/robust_weights.h"
#include "fitting/sparse/selection.h"
#include "fitting/sparse/sparse_fitter.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace sheen::fitting::sparse {
namespace {

using testing::add_sample;
using testing::colour_of;
using testing::disc_grid;
using testing::isolated;
using testing::Lumisphere;
using testing::one_sample;
using testing::scattered;
using testing::teach;

std::unique_ptr<PatchFitter> make_sparse(std::size_t patches = 1, int threads = 1,
                                         const Options& options = {}) {
  return make_sparse_fitter(isolated(patches), options, threads);
}

PatchModel patch_of(const Fitter& fitter, std::size_t patch_idx = 0) {
  return dynamic_cast<const LightFieldModel&>(fitter.light_field()).patch(patch_idx);
}

/// A highlight as wide as a RBF of the finest level, on grey.
Eigen::Vector3d highlight(double u, double v) {
  const double squared = (u - 0.3) * (u - 0.3) + (v + 0.2) * (v + 0.2);
  return Eigen::Vector3d(0.3, 0.25, 0.2) +
         Eigen::Vector3d::Constant(0.5 * std::exp(-squared / 0.04));
}

std::vector<DirectedColour> sampled(const std::vector<Eigen::Vector2d>& directions,
                                    const Lumisphere& truth) {
  std::vector<DirectedColour> samples;
  for (const Eigen::Vector2d& x : directions) {
    samples.push_back({x.cast<float>(), truth(x.x(), x.y()).cast<float>()});
  }
  return samples;
}

TEST(SparseFit, MattePatchEndsAsOneColour) {
  constexpr unsigned seed = 1;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Eigen::Vector3d truth(0.6, 0.4, 0.2);
  const auto fitter = make_sparse();
  teach(*fitter, scattered(96, seed), [&](double, double) -> Eigen::Vector3d {
    // Uniform noise of standard deviation 0.01: half width 0.01 sqrt(3).
    const double noise =
        (static_cast<double>(random()) / 4294967295.0 - 0.5) * 0.02 * std::sqrt(3.0);
    return truth.array() + noise;
  });
  // Three numbers; the mean of 96 samples is off by 0.01 / sqrt(96) = 0.001, four deviations 0.004.
  EXPECT_EQ(fitter->light_field().coefficient_count(), 3u);
  const Eigen::Vector3d mean = colour_of(fitter->light_field(), 0, {0, 0}).cast<double>();
  EXPECT_LT((mean - truth).cwiseAbs().maxCoeff(), 0.004);
}

TEST(SparseFit, SingleRbfIsFoundWithItsAtom) {
  // The lumisphere is the constant and one atom: the fit must name it and no other.
  const std::uint16_t atom_idx = 40;
  PatchModel truth;
  truth.coefficient[0] = Eigen::Vector3f(0.3f, 0.3f, 0.3f);
  truth.rbf_count = 1;
  truth.atom[0] = atom_idx;
  truth.coefficient[1] = Eigen::Vector3f(0.4f, 0.3f, 0.2f);
  const auto fitter = make_sparse();
  teach(*fitter, scattered(96, 2), [&](double u, double v) -> Eigen::Vector3d {
    return evaluate(truth, {static_cast<float>(u), static_cast<float>(v)}).cast<double>();
  });
  const PatchModel fitted = patch_of(*fitter);
  ASSERT_EQ(fitted.base_terms, kConstantBase);
  ASSERT_EQ(fitted.rbf_count, 1u);
  EXPECT_EQ(fitted.atom[0], atom_idx);
  // Two terms of three numbers and one index.
  EXPECT_EQ(fitter->light_field().coefficient_count(), 7u);
}

TEST(SparseFit, LinearLumisphereTakesTheLinearBase) {
  const auto fitter = make_sparse();
  teach(*fitter, scattered(96, 3), [](double u, double v) {
    return Eigen::Vector3d(0.5 + 0.3 * u, 0.5 - 0.2 * v, 0.4 + 0.1 * (u + v));
  });
  const PatchModel fitted = patch_of(*fitter);
  EXPECT_EQ(fitted.base_terms, kLinearBase);
  EXPECT_EQ(fitted.rbf_count, 0u);
}

TEST(SparseFit, HighlightIsBetterThanOneColour) {
  double squared = 0;
  double squared_of_mean = 0;
  for (unsigned seed = 4; seed < 14; ++seed) {
    const auto fitter = make_sparse();
    teach(*fitter, scattered(96, seed), highlight);
    const PatchLightField& fitted = fitter->light_field();
    const Eigen::Vector3d mean = fitted.mean_colour(0).cast<double>();
    for (const Eigen::Vector2f& x : disc_grid()) {
      const Eigen::Vector3d truth =
          highlight(static_cast<double>(x.x()), static_cast<double>(x.y()));
      squared += (colour_of(fitted, 0, x).cast<double>() - truth).squaredNorm();
      squared_of_mean += (mean - truth).squaredNorm();
    }
  }
  // A tenth of the variance is 10 dB.
  EXPECT_LT(squared, 0.1 * squared_of_mean);
}

TEST(SparseFit, OrderOfViewsDoesNotMatter) {
  auto directions = scattered(60, 5);
  const auto forwards = make_sparse();
  teach(*forwards, directions, highlight);
  std::reverse(directions.begin(), directions.end());
  const auto backwards = make_sparse();
  teach(*backwards, directions, highlight);
  // The same least-squares problem: sums in another order differ in the last bits of a float,
  // coefficients are halves.
  for (const Eigen::Vector2f& x : disc_grid(8, 16)) {
    const Eigen::Vector3f difference =
        colour_of(forwards->light_field(), 0, x) - colour_of(backwards->light_field(), 0, x);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.002f);
  }
}

TEST(SparseFit, ThreadsDoNotMatter) {
  constexpr std::size_t patches = 1500;  // enough for several ranges
  const auto one = make_sparse(patches, 1);
  const auto three = make_sparse(patches, 3);
  for (const Eigen::Vector2d& x : scattered(12, 6)) {
    core::SampleBatch batch;
    for (std::uint32_t patch = 0; patch < patches; ++patch) {
      const Eigen::Vector2d turned(x.x() * std::cos(patch) - x.y() * std::sin(patch),
                                   x.x() * std::sin(patch) + x.y() * std::cos(patch));
      add_sample(batch, patch, turned, highlight(turned.x(), turned.y()));
    }
    EXPECT_EQ(one->integrate(batch).elements, three->integrate(batch).elements);
  }
  one->finish();
  three->finish();
  EXPECT_EQ(one->statistics().fits, three->statistics().fits);
  for (std::size_t patch = 0; patch < patches; ++patch) {
    const PatchModel a = patch_of(*one, patch);
    const PatchModel b = patch_of(*three, patch);
    ASSERT_EQ(a.term_count(), b.term_count());
    for (std::size_t i = 0; i < a.term_count(); ++i) {
      ASSERT_EQ(a.coefficient[i], b.coefficient[i]) << "patch " << patch;
    }
  }
}

TEST(SparseFit, FewSamplesGiveTheirMean) {
  for (const std::size_t count : {1u, 2u, 3u}) {
    const auto fitter = make_sparse();
    const auto directions = scattered(count, 7);
    teach(*fitter, directions, highlight);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector2d& x : directions) mean += highlight(x.x(), x.y());
    mean /= static_cast<double>(count);
    // Below four samples a patch is one colour; halves near 0.5 are exact to 0.00025.
    const Eigen::Vector3d fitted = colour_of(fitter->light_field(), 0, {0.7f, 0}).cast<double>();
    EXPECT_LT((fitted - mean).cwiseAbs().maxCoeff(), 0.0005) << count;
    EXPECT_EQ(fitter->light_field().coefficient_count(), 3u);
  }
}

TEST(SparseFit, RepeatedDirectionGivesTheMean) {
  const auto fitter = make_sparse();
  for (int i = 0; i < 40; ++i) {
    fitter->integrate(
        one_sample(0, {0.3, -0.4}, Eigen::Vector3d::Constant(i % 2 == 0 ? 0.2 : 0.8)));
  }
  fitter->finish();
  const Eigen::Vector3f seen = colour_of(fitter->light_field(), 0, {0.3f, -0.4f});
  EXPECT_NEAR(seen.x(), 0.5f, 0.01f);
}

TEST(SparseFit, CollinearSweepStaysInRange) {
  // A ramp over half the disc's diameter, 0.3 to 0.7: continued as a line it is 0.1 to 0.9 at the
  // rim; nothing may go further.
  const auto fitter = make_sparse();
  for (int i = 0; i < 40; ++i) {
    const double u = -0.5 + i / 39.0;
    fitter->integrate(one_sample(0, {u, 0.0}, Eigen::Vector3d::Constant(0.5 + 0.4 * u)));
  }
  fitter->finish();
  for (const Eigen::Vector2f& x : disc_grid()) {
    const Eigen::Vector3f colour = colour_of(fitter->light_field(), 0, x);
    ASSERT_GT(colour.minCoeff(), 0.1f - 0.05f);
    ASSERT_LT(colour.maxCoeff(), 0.9f + 0.05f);
  }
}

TEST(SparseFit, UnusableSamplesAreIgnored) {
  const auto fitter = make_sparse();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  fitter->integrate(one_sample(0, {nan, 0.0}, {0.5, 0.5, 0.5}));
  fitter->integrate(one_sample(0, {0.0, 0.0}, {0.5, inf, 0.5}));
  EXPECT_EQ(fitter->statistics().samples, 0u);
  fitter->integrate(one_sample(0, {0.0, 0.0}, {0.25, 0.25, 0.25}));
  fitter->finish();
  EXPECT_EQ(colour_of(fitter->light_field(), 0, {0, 0}), Eigen::Vector3f::Constant(0.25f));
}

TEST(SparseFit, HoldingStillForMinutesKeepsTheModel) {
  // With a given tolerance: 5000 equal samples would say that the camera has no noise.
  const auto fitter = make_sparse(1, 1, {.tolerance = 0.02f});
  teach(*fitter, scattered(90, 8), highlight);
  const Eigen::Vector3f before = colour_of(fitter->light_field(), 0, {0.3f, -0.2f});
  for (int i = 0; i < 5000; ++i) {
    fitter->integrate(one_sample(0, {-0.5, 0.5}, highlight(-0.5, 0.5)));
  }
  fitter->finish();
  // The crowd is one kept sample.
  const Eigen::Vector3f after = colour_of(fitter->light_field(), 0, {0.3f, -0.2f});
  EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 0.02f);
}

TEST(SparseFit, LoneOutlierIsDiscountedAndHighlightIsNot) {
  const auto grey = [](double, double) -> Eigen::Vector3d { return {0.3, 0.3, 0.3}; };
  Selection selection{Options{}};
  std::vector<DirectedColour> samples = sampled(scattered(64, 9), grey);
  // One stray sample: what is drawn there stays nearer to grey than to the stray.
  auto with_stray = samples;
  with_stray[10].rgb = Eigen::Vector3f::Constant(0.9f);
  const PatchModel stray = selection.choose(with_stray).model;
  EXPECT_LT(evaluate(stray, with_stray[10].uv).x(), 0.6f);
  // Three that agree: drawn nearer to their colour.
  const Eigen::Vector2f place = samples[10].uv;
  auto with_highlight = samples;
  for (const Eigen::Vector2f& offset :
       {Eigen::Vector2f(0, 0), Eigen::Vector2f(0.04f, 0), Eigen::Vector2f(0, 0.04f)}) {
    with_highlight.push_back({place + offset, Eigen::Vector3f::Constant(0.9f)});
  }
  with_highlight.erase(with_highlight.begin() + 10);
  const PatchModel bright = selection.choose(with_highlight).model;
  EXPECT_GT(evaluate(bright, place).x(), 0.6f);
}

TEST(SparseFit, WeightsFadeBeyondFiveDeviations) {
  // Median 0.1: threshold 5 x 1.4826 x 0.1 = 0.7413. At twice that the factor is 1 / 4.
  const std::array<float, 5> residuals{0.1f, 0.1f, 0.74f, 0.05f, 1.4826f};
  const float threshold = suspect_threshold(residuals, 0.001f);
  EXPECT_EQ(robust_factor(0.1f, threshold), 1.0f);
  EXPECT_EQ(robust_factor(0.74f, threshold), 1.0f);
  EXPECT_NEAR(robust_factor(1.4826f, threshold), 0.25f, 1e-5f);
  // The floor stands in for a median of zero: threshold 5 x 0.01.
  const std::array<float, 3> calm{0.0f, 0.0f, 0.04f};
  EXPECT_FLOAT_EQ(suspect_threshold(calm, 0.01f), 0.05f);
}

TEST(SparseFit, ResidualsAroundASampleAreThoseOfItsNeighbours) {
  // Twenty samples on a line, residuals 0 to 1.9: nearest to number 10 are 7, 8, 9, 11, 12, 13 and
  // one of 6 and 14; the middle one of these is 9 or 11.
  std::vector<DirectedColour> samples;
  std::vector<float> residuals;
  for (int i = 0; i < 20; ++i) {
    samples.push_back({{0.04f * static_cast<float>(i) - 0.4f, 0}, Eigen::Vector3f::Zero()});
    residuals.push_back(0.1f * static_cast<float>(i));
  }
  EXPECT_NEAR(residual_around(samples, residuals, 10), 1.0f, 0.101f);
  EXPECT_EQ(residual_around({samples.data(), 1}, {residuals.data(), 1}, 0), 0.0f);
}

TEST(SparseFit, PredictedErrorIsFiniteAndRisesAwayFromSamples) {
  const auto fitter = make_sparse(2);
  // Only the half u < 0 is seen.
  for (const Eigen::Vector2d& x : scattered(80, 11)) {
    if (x.x() < 0) fitter->integrate(one_sample(0, x, highlight(x.x(), x.y())));
  }
  fitter->finish();
  for (const Eigen::Vector2f& x : disc_grid()) {
    const auto error = fitter->predicted_error(0, x);
    ASSERT_TRUE(error.has_value());
    ASSERT_TRUE(std::isfinite(*error) && *error >= 0.0f);
  }
  EXPECT_GT(*fitter->predicted_error(0, {0.95f, 0}), *fitter->predicted_error(0, {-0.5f, 0}));
  // Nothing is known of a patch never seen.
  EXPECT_FALSE(fitter->predicted_error(1, {0, 0}).has_value());
}

TEST(SparseFit, BadOptionsAreRefused) {
  EXPECT_THROW(make_sparse(1, 1, {.tolerance = 0.0f}), std::invalid_argument);
  EXPECT_THROW(make_sparse(1, 1, {.tolerance = std::numeric_limits<float>::quiet_NaN()}),
               std::invalid_argument);
  EXPECT_THROW(make_sparse(1, 1, {.criterion_weight = -1.0f}), std::invalid_argument);
  EXPECT_THROW(make_sparse(1, 1, {.max_samples = 4}), std::invalid_argument);
  EXPECT_THROW(make_sparse(1, 1, {.max_samples = 129}), std::invalid_argument);
}

}  // namespace
}  // namespace sheen::fitting::sparse
