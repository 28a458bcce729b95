// SPDX-License-Identifier: MIT
// Exposure and white balance between walks: gains that were applied are found back, equal walks get
// exactly none, and levels are used only where held-out views are predicted better by them. Joining
// stays associative and commutative to the last bit.
#include "fitting/state/level_walks.h"
#include "tests/fitting/samples_for_tests.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace sheen::fitting {
namespace {

constexpr std::size_t kPatches = 60;
constexpr int kFrames = 24;
constexpr Gain kCold{0.7, 0.85, 1.1};

double unit(std::mt19937& random) {
  return static_cast<double>(random()) / 4294967296.0;
}

/// A view of an object whose patches darken towards one side; codes from .3 to .8, noise of 1 %.
core::SampleBatch view(unsigned seed) {
  std::mt19937 random(seed);
  core::SampleBatch batch;
  for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
    const Eigen::Vector2d x(1.2 * unit(random) - 0.6, 1.2 * unit(random) - 0.6);
    const double shade = 1 + 0.2 * x.x() + 0.01 * (unit(random) - 0.5);
    const double base = 0.4 + 0.2 * patch / kPatches;
    testing::add_sample(batch, patch, x, shade * Eigen::Vector3d(base, base + 0.05, 0.95 * base));
  }
  return batch;
}

/// Frames of a walk; its seed says where its cameras stood.
std::vector<core::SampleBatch> walk(unsigned seed, const Gain& gain) {
  std::vector<core::SampleBatch> views;
  for (unsigned frame = 0; frame < kFrames; ++frame) {
    views.push_back(view(1000 * seed + frame));
    multiply_light(gain, views.back());
  }
  return views;
}

std::vector<Gain> gains_of(const std::vector<std::vector<core::SampleBatch>>& walks) {
  WalkGains overlap(walks.size(), kPatches);
  for (std::size_t i = 0; i < walks.size(); ++i) {
    for (const core::SampleBatch& batch : walks[i]) overlap.add(i, batch);
  }
  return overlap.estimate();
}

void expect_near(const Gain& found, const Gain& expected, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.at(c) / expected.at(c), 1, tolerance) << c;
  }
}

// The light of copies has one ratio in every cell, but for rounding: to code and back costs light
// c at most 2.4 (c + .055)^-1 c < 2.4 times a code's 2^-24 at either end and some four of these for
// the powers, and sums of at most 24 samples 24 times 2^-24. Together below 60 / 2^24 = 3.6e-6.
TEST(WalkGains, OfCopiesAreFoundBack) {
  const Gain warm{1.2, 1.0, 0.75};
  const auto found = gains_of({walk(1, kNoGain), walk(1, kCold), walk(1, warm)});
  EXPECT_EQ(found[0], kNoGain);  // as many views as the others, and the first
  expect_near(found[1], kCold, 3.6e-6);
  expect_near(found[2], warm, 3.6e-6);
}

// Codes of 8 bits are off by 1/sqrt(12) of 1/255, their light by 2.4 / (c + .055) of that: at most
// .9 % at the darkest code, .25. Of the median over 60 patches' cells, about 8 of each: 1.25
// sqrt(2) .9 % / sqrt(480) = .073 %; four times that is allowed.
TEST(WalkGains, OfCopiesInEightBitsAreFoundBack) {
  auto first = walk(1, kNoGain);
  auto second = walk(1, kCold);
  for (auto* views : {&first, &second}) {
    for (core::SampleBatch& batch : *views) {
      for (auto* column : {&batch.r, &batch.g, &batch.b}) {
        for (float& value : *column) value = std::round(255 * value) / 255;
      }
    }
  }
  expect_near(gains_of({first, second})[1], kCold, 0.003);
}

TEST(WalkGains, OfEqualWalksAreExactlyNone) {
  const auto found = gains_of({walk(1, kCold), walk(1, kCold), walk(1, kCold)});
  for (const Gain& gain : found) EXPECT_EQ(gain, kNoGain);
}

// Walks that overlap by way of others are levelled, those that do not are left alone.
TEST(WalkGains, GoByWayOfOtherWalks) {
  const auto patches = [](std::uint32_t first, std::uint32_t end, const Gain& gain) {
    auto views = walk(1, gain);
    for (core::SampleBatch& batch : views) {
      core::SampleBatch kept;
      for (std::uint32_t i = first; i < end; ++i) {
        testing::add_sample(kept, i, Eigen::Vector2d(batch.u[i], batch.v[i]),
                            Eigen::Vector3d(batch.r[i], batch.g[i], batch.b[i]));
      }
      batch = kept;
    }
    return views;
  };
  const Gain product{kCold[0] * kCold[0], kCold[1] * kCold[1], kCold[2] * kCold[2]};
  const auto found = gains_of({patches(0, 20, kNoGain), patches(10, 30, kCold),
                               patches(20, 40, product), patches(40, 60, kCold)});
  expect_near(found[1], kCold, 1e-5);
  expect_near(found[2], product, 1e-5);
  EXPECT_EQ(found[3], kNoGain);
}

class LevelWalks : public ::testing::Test {
 protected:
  using States = std::vector<std::unique_ptr<StateReader>>;

  std::filesystem::path make(const std::string& name, unsigned seed, const Gain& gain) {
    core::Mesh mesh;
    mesh.positions.assign(kPatches, Eigen::Vector3f::Zero());
    mesh.normals.assign(kPatches, Eigen::Vector3f::UnitZ());
    StateWriter writer(folder_ / name, {"sh", {}, mesh});
    int frame = 0;
    for (const core::SampleBatch& batch : walk(seed, gain))
      writer.append({name, 7, frame++}, batch);
    writer.commit();
    return folder_ / name;
  }

  static States open(const std::vector<std::filesystem::path>& paths) {
    States states;
    for (const auto& path : paths) states.push_back(std::make_unique<StateReader>(path));
    return states;
  }
  std::filesystem::path merge(const std::string& name,
                              const std::vector<std::filesystem::path>& paths) {
    const States states = open(paths);
    write_joined(folder_ / name, states, join(states), nothing);
    return folder_ / name;
  }
  static WalkLevels levels_of(const States& states) {
    return level_walks(states, join(states), 1, nothing);
  }
  static std::string model_of(const States& states, const WalkLevels& levels) {
    return testing::bytes_of(
        fit_joined(states, join(states), levels, 1, nothing).fitter->light_field());
  }
  static void nothing(std::size_t /*views*/) {}

  tests::TemporaryFolder folder_;
};

// Held-out codes are about .5 and off by half of what 15 % of light or more change them, 7 %, while
// they are not levelled, and by the noise of 1 % and what harmonics cannot show after.
TEST_F(LevelWalks, LevelsWalksOfDifferentExposure) {
  const States states = open({make("a", 1, kNoGain), make("b", 2, kCold)});
  const WalkLevels levels = levels_of(states);
  ASSERT_TRUE(levels.trial);
  EXPECT_TRUE(levels.is_used);
  EXPECT_GT(levels.trial->as_is, 0.02);
  EXPECT_LT(levels.trial->levelled, levels.trial->as_is / 4);
  // Other directions, so what a cell holds differs by its width: 2/8 of .2, of which 20 views leave
  // less than a tenth in the median.
  expect_near(levels.walks[1].gain, kCold, 0.01);

  // The model is that of walks in one light, but for the same.
  const States even = open({folder_ / "a", make("b2", 2, kNoGain)});
  const auto lit = fit_joined(even, join(even), {}, 1, nothing);
  const auto fit = fit_joined(states, join(states), levels, 1, nothing);
  const auto& expected = require_patches(lit.fitter->light_field(), "test");
  const auto& found = require_patches(fit.fitter->light_field(), "test");
  for (std::size_t i = 0; i < kPatches; ++i) {
    EXPECT_LT((found.mean_colour(i) - expected.mean_colour(i)).cwiseAbs().maxCoeff(), 0.01);
  }
}

TEST_F(LevelWalks, LeavesWalksOfOneExposure) {
  const States copies = open({make("a", 1, kNoGain), make("b", 1, kNoGain)});
  EXPECT_FALSE(levels_of(copies).trial);  // exactly no gain: nothing to try
  const States states = open({folder_ / "a", make("c", 2, kNoGain)});
  const WalkLevels levels = levels_of(states);
  ASSERT_TRUE(levels.trial);
  EXPECT_FALSE(levels.is_used);
  EXPECT_EQ(model_of(states, levels), model_of(states, {}));
}

TEST_F(LevelWalks, DoNotDependOnHowStatesWereJoined) {
  const auto a = make("a", 1, kNoGain);
  const auto b = make("b", 2, kCold);
  const auto c = make("c", 3, {1.1, 1.1, 1.1});
  const auto model = [](const States& states) { return model_of(states, levels_of(states)); };
  const std::string once = model(open({a, b, c}));
  EXPECT_NE(once, model_of(open({a, b, c}), {}));
  EXPECT_EQ(model(open({c, merge("ab", {b, a})})), once);
  EXPECT_EQ(model(open({merge("ca", {c, a}), b})), once);
}

}  // namespace
}  // namespace sheen::fitting
