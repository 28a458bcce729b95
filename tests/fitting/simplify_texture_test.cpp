// SPDX-License-Identifier: MIT
#include "fitting/detail/simplify_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace sheen::fitting::detail {
namespace {

constexpr int kSide = 128;
constexpr float kNoise = 4.0f;
constexpr float kObservations = 16.0f;

/// One chart of kSide x kSide texels.
core::Atlas atlas() {
  core::Atlas atlas;
  atlas.width = kSide;
  atlas.height = kSide;
  atlas.charts = {{{0, 0}, {kSide, kSide}}};
  return atlas;
}

Planes texture_of(const std::function<float(int x, int y)>& value) {
  Planes planes;
  for (auto& plane : planes) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) plane.push_back(value(x, y));
    }
  }
  return planes;
}

TexelCount simplify(Planes& planes, int threads = 1) {
  const std::vector<float> weight(planes[0].size(), kObservations);
  return simplify_texture(atlas(), weight, kNoise, threads, planes);
}

double rms(const Planes& a, const Planes& b) {
  double squared = 0;
  for (std::size_t i = 0; i < a[0].size(); ++i) {
    squared += std::pow(static_cast<double>(a[0][i] - b[0][i]), 2);
  }
  return std::sqrt(squared / static_cast<double>(a[0].size()));
}

TEST(SimplifyTexture, AConstantChartIsOneColour) {
  Planes planes = texture_of([](int, int) { return 77.0f; });
  const TexelCount count = simplify(planes);
  EXPECT_EQ(count.stored, 1u);
  EXPECT_EQ(count.offered, static_cast<std::size_t>(kSide * kSide));
  for (const float value : planes[0]) EXPECT_NEAR(value, 77.0f, 1e-3f);
}

// The mean of 16 observations with a deviation of 4 has one of 1. A chart of that is one colour,
// the mean of 16384 texels: it is off by 1 / 128 or a few times that.
TEST(SimplifyTexture, NoiseIsTakenOut) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, kNoise / std::sqrt(kObservations));
  Planes planes = texture_of([&](int, int) { return 100.0f + noise(random); });
  EXPECT_EQ(simplify(planes).stored, 1u);
  EXPECT_NEAR(planes[0][0], 100.0f, 0.05f);
  EXPECT_EQ(planes[0].front(), planes[0].back());
}

// What changes linearly takes the corners of the four largest tiles, and stays.
TEST(SimplifyTexture, ARampTakesTheCornersOfItsTiles) {
  const auto ramp = [](int x, int y) {
    return 20.0f + static_cast<float>(x) + 0.5f * static_cast<float>(y);
  };
  Planes planes = texture_of(ramp);
  EXPECT_EQ(simplify(planes).stored, 16u);
  EXPECT_LT(rms(planes, texture_of(ramp)), 1e-3);
}

// Print on one half: that half keeps every texel as it is, the plain one takes little.
TEST(SimplifyTexture, PrintStays) {
  std::mt19937 random(6);
  std::vector<float> print;
  for (int i = 0; i < kSide * kSide; ++i) print.push_back(static_cast<float>(random() % 200));
  const auto look = [&](int x, int y) {
    return x < kSide / 2 ? 50.0f : print[static_cast<std::size_t>(y * kSide + x)];
  };
  Planes planes = texture_of(look);
  const TexelCount count = simplify(planes);
  constexpr auto half = static_cast<std::size_t>(kSide * kSide / 2);
  EXPECT_EQ(count.stored, half + 2 * 4);  // two tiles of 64 are plain
  EXPECT_LT(rms(planes, texture_of(look)), 1e-3);
}

// Never does a texture move by more than the criterion allows: n r^2 / noise^2 <= 2 a number.
TEST(SimplifyTexture, StaysWithinTwiceTheNoise) {
  const auto waves = [](int x, int y) {
    return 100.0f +
           3.0f * std::sin(0.3f * static_cast<float>(x) + 0.01f * static_cast<float>(x * y));
  };
  Planes planes = texture_of(waves);
  const TexelCount count = simplify(planes);
  EXPECT_LT(count.stored, count.offered);
  const double deviation_of_a_mean = static_cast<double>(kNoise / std::sqrt(kObservations));
  EXPECT_LE(rms(planes, texture_of(waves)), std::sqrt(2.0) * deviation_of_a_mean);
}

TEST(SimplifyTexture, LeavesTexelsThatNoReadingTouches) {
  Planes planes = texture_of([](int x, int y) { return static_cast<float>(x ^ y); });
  const Planes before = planes;
  std::vector<float> weight(planes[0].size(), -1.0f);
  const TexelCount nothing = simplify_texture(atlas(), weight, kNoise, 1, planes);
  EXPECT_EQ(nothing.offered, 0u);
  EXPECT_EQ(nothing.stored, 0u);
  EXPECT_EQ(planes, before);
  // One texel, and one that was never observed: it follows.
  weight[300] = 4;
  weight[301] = 0;
  EXPECT_EQ(simplify_texture(atlas(), weight, kNoise, 1, planes).stored, 1u);
  EXPECT_NEAR(planes[0][301], before[0][300], 0.1f);
}

TEST(SimplifyTexture, ThreadsDoNotChangeABit) {
  core::Atlas two = atlas();
  two.charts = {{{0, 0}, {kSide, 50}}, {{0, 50}, {kSide, kSide - 50}}};
  std::mt19937 random(7);
  Planes one = texture_of([&](int x, int) { return static_cast<float>(random() % (1 + x / 8)); });
  Planes many = one;
  const std::vector<float> weight(one[0].size(), kObservations);
  const TexelCount first = simplify_texture(two, weight, kNoise, 1, one);
  const TexelCount second = simplify_texture(two, weight, kNoise, 7, many);
  EXPECT_EQ(one, many);
  EXPECT_EQ(first.stored, second.stored);
}

}  // namespace
}  // namespace sheen::fitting::detail
