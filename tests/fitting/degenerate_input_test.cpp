// SPDX-License-Identifier: MIT
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace sheen::fitting {
namespace {

using testing::make_iwls;
using testing::text_of;
using Directions = std::vector<Eigen::Vector2d>;

Eigen::Vector3d steep(double u, double v) {
  return {0.5 + 0.45 * std::sin(9 * u + 4 * v), 0.5 + 0.4 * u, v > 0 ? 0.9 : 0.1};
}

// What a two_lobes patch shows: two lobes on a matt ground.
Eigen::Vector3d two_lobes(double u, double v) {
  const double z = std::sqrt(std::max(0.0, 1.0 - u * u - v * v));
  const double broad = std::pow(std::max(0.0, -0.5 * u + 0.3 * v + 0.81 * z), 12);
  const double sharp = std::pow(std::max(0.0, 0.6 * u - 0.2 * v + 0.77 * z), 40);
  return {0.3 + 0.5 * broad, 0.2 + 0.1 * u + 0.4 * sharp, 0.4 + 0.3 * broad + 0.3 * sharp};
}

struct Range {
  double lowest = 1e9, highest = -1e9;
};

Range range_of_model(const PatchLightField& light_field) {
  Range range;
  for (const auto& x : testing::disc_grid(40, 80)) {
    const WeightedColour sum = light_field.evaluate(0, x);
    EXPECT_GT(sum.weight_sum, 0.0f);
    EXPECT_TRUE(sum.colour_sum.allFinite());
    const Eigen::Vector3d colour = (sum.colour_sum / sum.weight_sum).cast<double>();
    range.lowest = std::min(range.lowest, colour.minCoeff());
    range.highest = std::max(range.highest, colour.maxCoeff());
  }
  return range;
}

// One handheld arc: directions on a line that misses the centre, many of them.
Directions collinear(std::size_t count) {
  Directions directions;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = -0.7 + 1.4 * static_cast<double>(i) / static_cast<double>(count - 1);
    directions.emplace_back(0.8 * t + 0.2, 0.6 * t - 0.3);
  }
  return directions;
}

Directions rim(std::size_t count) {
  Directions directions;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.3 * static_cast<double>(i) / static_cast<double>(count);
    directions.emplace_back(std::cos(angle), std::sin(angle));
  }
  return directions;
}

struct HardCase {
  const char* name;
  Directions directions;
};

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases{{"one", {{0.3, 0.4}}},
                              {"two", {{0.3, 0.4}, {0.31, 0.4}}},
                              {"three", {{0.3, 0.4}, {0.31, 0.4}, {-0.8, 0.2}}},
                              {"collinear", collinear(200)},
                              {"repeated", Directions(1000, {0.3, 0.4})},
                              {"rim", rim(60)}};
  // A sweep as hands make it: wobble of half a degree across the line.
  Directions wobbly = collinear(300);
  for (std::size_t i = 0; i < wobbly.size(); ++i) {
    wobbly[i] += 0.008 * std::sin(12.9898 * static_cast<double>(i)) * Eigen::Vector2d(-0.6, 0.8);
  }
  cases.push_back({"wobbly", wobbly});
  return cases;
}

TEST(DegenerateInput, NeverMakesAModelThatIsNotFinite) {
  for (const HardCase& hard : hard_cases()) {
    for (const bool faithful : {false, true}) {
      testing::for_all_options(faithful ? 3 : 0, faithful, [&](const iwls::Options& options) {
        const auto fitter = make_iwls(options);
        for (const auto& x : hard.directions) {
          fitter->integrate(testing::one_sample(0, x, steep(x.x(), x.y())));
        }
        range_of_model(fitter->light_field());
        fitter->finish();
        range_of_model(fitter->light_field());
      });
    }
  }
}

// With the ridge no direction may leave the range of the samples by more than a tenth: the first
// views and one-sided sweeps are what people look at while they capture.
TEST(DegenerateInput, RidgeFitsStayNearTheRangeOfTheSamples) {
  for (const HardCase& hard : hard_cases()) {
    Range samples;
    for (const auto& x : hard.directions) {
      samples.lowest = std::min(samples.lowest, two_lobes(x.x(), x.y()).minCoeff());
      samples.highest = std::max(samples.highest, two_lobes(x.x(), x.y()).maxCoeff());
    }
    for (const int terms : {0, 1, 3}) {
      testing::for_all_options(terms, false, [&](const iwls::Options& options) {
        const auto fitter = make_iwls(options);
        testing::teach(*fitter, hard.directions, two_lobes);
        const Range model = range_of_model(fitter->light_field());
        EXPECT_GT(model.lowest, samples.lowest - 0.1) << hard.name << " " << text_of(options);
        EXPECT_LT(model.highest, samples.highest + 0.1) << hard.name << " " << text_of(options);
      });
    }
  }
}

TEST(DegenerateInput, SamplesThatAreNotNumbersAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const char* name : {"iwls", "mean"}) {
    const auto fitter = make_isolated_patches(name, 2);
    core::SampleBatch batch = testing::one_sample(0, {0.1, 0.2}, {0.4, 0.5, 0.6});
    testing::add_sample(batch, 1, {0.1, 0.2}, {0.4, 0.5, 0.6});
    for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) {
      for (const float bad : {nan, infinity, -infinity, 1e30f}) {
        core::SampleBatch broken = batch;
        (*(column == &batch.u   ? &broken.u
           : column == &batch.v ? &broken.v
           : column == &batch.r ? &broken.r
           : column == &batch.g ? &broken.g
                                : &broken.b))[1] = bad;
        fitter->integrate(broken);
      }
    }
    // 20 views reached patch 0, none patch 1.
    EXPECT_EQ(fitter->statistics().samples, 20u);
    fitter->finish();
    EXPECT_EQ(fitter->light_field().observed(), (std::vector<std::uint8_t>{1, 0}));
    EXPECT_NEAR(fitter->light_field().mean_colour(0).x(), 0.4f, 1e-3f);
  }
}

// Hundred thousand samples in a spot of sigma .004 around one direction: sums of a long run must
// keep what little spread there is. The truth is linear, so an exact faithful fit has only rounding
// of halves (2^-12 of the value, slopes times at most the spot) - if the sums had lost precision,
// slopes of hundreds would show.
TEST(DegenerateInput, LongRunsInOneSpotLoseNoPrecision) {
  const auto truth = [](double u, double v) {
    return Eigen::Vector3d(0.5 + 0.2 * u, 0.4 - 0.2 * v, 0.3 + 0.1 * u - 0.1 * v);
  };
  Directions directions;
  for (const auto& x : testing::scattered(100000, 51)) {
    directions.push_back(Eigen::Vector2d(0.31, -0.22) + 0.008 * x);  // sigma = radius / 2
  }
  for (const auto& [terms, faithful] :
       {std::pair{3, true}, std::pair{3, false}, std::pair{6, false}}) {
    for (const auto construction : testing::kConstructions) {
      const auto fitter = make_iwls({construction, iwls::Layout::grid, 16, terms, faithful});
      testing::teach(*fitter, directions, truth);
      double squared = 0;
      for (std::size_t i = 0; i < 1000; ++i) {
        const auto& x = directions[i];
        const auto value = testing::colour_of(fitter->light_field(), 0, x.cast<float>());
        squared += (value.cast<double>() - truth(x.x(), x.y())).squaredNorm() / 3;
      }
      EXPECT_LT(std::sqrt(squared / 1000), 1e-3)
          << iwls::name_of(construction) << " " << terms << faithful;
    }
  }
}

}  // namespace
}  // namespace sheen::fitting
