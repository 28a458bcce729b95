// SPDX-License-Identifier: MIT
#include "evaluation/study/view_sets.h"

#include "evaluation/study/handheld_path.h"
#include "evaluation/study/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

TEST(ViewSets, StayAboveTheHorizonAndOnTheSphere) {
  for (const ViewSet set : kViewSets) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const std::vector<View> views = make_views(set, 64, seed);
      ASSERT_EQ(views.size(), 64u);
      for (const View& view : views) {
        EXPECT_NEAR(view.direction.norm(), 1.0f, 1e-5f);
        // A bunch of `clusters` may lean over the edge by rounding only.
        EXPECT_GT(view.direction.z(), kMinCosine - 1e-3f) << name_of(set);
      }
    }
  }
}

TEST(ViewSets, GapLeavesOutASectorOf100Degrees) {
  for (const View& view : make_views(ViewSet::gap, 500, 1)) {
    const double azimuth = static_cast<double>(std::atan2(view.direction.y(), view.direction.x()) *
                                               180.0f / std::numbers::pi_v<float>);
    EXPECT_GE(std::abs(azimuth), 50.0 - 1e-3);
  }
  // 100 of 360 degrees: a binomial with standard error sqrt(.28 * .72 / 2000) = .01.
  int inside = 0;
  for (const Vector3f& direction : test_directions(2000, 1)) inside += in_gap(direction) ? 1 : 0;
  EXPECT_NEAR(inside / 2000.0, 100.0 / 360.0, 0.05);
}

// Four bunches with a radius of 6 degrees: every view is within 12 degrees of the one four earlier.
TEST(ViewSets, ClustersAreFourBunches) {
  const std::vector<View> views = make_views(ViewSet::clusters, 64, 3);
  const float nearest = std::cos(12.1f * std::numbers::pi_v<float> / 180.0f);
  for (std::size_t i = 4; i < views.size(); ++i) {
    EXPECT_GT(views[i].direction.dot(views[i - 4].direction), nearest);
  }
}

// A single sweep is close to a curve: on the disc its samples lie near an ellipse's arc, so
// scattered directions are farther from their nearest sample than with scattered samples.
TEST(ViewSets, OneArcLeavesMoreOfTheHemisphereUnseenThanThree) {
  const auto mean_distance = [](ViewSet set) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto views = make_views(set, 64, seed);
      for (const Vector3f& direction : test_directions(50, seed)) {
        float best = -1;
        for (const View& view : views) best = std::max(best, view.direction.dot(direction));
        sum += std::acos(std::min(1.0, static_cast<double>(best)));
      }
    }
    return sum / (20 * 50);
  };
  const double uni = mean_distance(ViewSet::uni);
  const double arc = mean_distance(ViewSet::arc);
  const double one_arc = mean_distance(ViewSet::one_arc);
  EXPECT_GT(arc, 1.5 * uni);
  EXPECT_GT(one_arc, 1.5 * arc);
}

// Time bends but never runs backwards: its slope is 1 + depth cos, at least 1 - .85.
TEST(HandheldPath, DwellKeepsTheOrderOfTime) {
  EXPECT_NEAR(with_dwell(0.0f, 0.3f), 0.0f, 1e-6f);
  EXPECT_NEAR(with_dwell(1.0f, 0.3f), 1.0f, 1e-5f);
  for (int i = 0; i < 1000; ++i) {
    const float time = static_cast<float>(i) / 1000.0f;
    EXPECT_GT(with_dwell(time + 0.001f, 0.3f), with_dwell(time, 0.3f));
  }
}

// A handheld walk is smooth. Three rounds are 6 pi of azimuth; the fastest stretch of time runs
// 1.85 times as fast: 34.9 rad for the whole walk, and 1.05 * 1.85 = 1.9 of elevation. A wobble of
// amplitudes .6, .3, .15 at most 2, 6, 10 times per unit has slopes up to 2 pi * 4.5 = 28.3; at
// four times the pace it adds .06 * 4 * 28.3 = 6.8 rad of azimuth and .09 * 4 * 28.3 = 10.2 of
// elevation. The root of 41.7 and 12.1 squared is 43.4 rad, 2.49 degrees from frame to frame of
// 1000. Without wobble it would be two; nobody walks at less than half of that throughout.
TEST(HandheldPath, WalkIsSmooth) {
  double fastest_deg = 0;
  for (std::uint64_t key = 1; key <= 20; ++key) {
    const HandheldOrbit orbit(key, 0.15f, 1.2f, 3.0f);
    for (int i = 0; i < 999; ++i) {
      const Vector3f here = orbit.at(static_cast<float>(i) / 1000.0f);
      const Vector3f next = orbit.at(static_cast<float>(i + 1) / 1000.0f);
      const double step = static_cast<double>(here.cross(next).norm());
      fastest_deg = std::max(fastest_deg, std::asin(step) * 180.0 / std::numbers::pi);
    }
  }
  std::cout << "fastest step " << fastest_deg << " degrees\n";
  EXPECT_LT(fastest_deg, 2.5);
  EXPECT_GT(fastest_deg, 1.0);
}

// The walk is as long as it takes: the mean number of samples is what was asked for, to within the
// rounding of the number of frames and the coarser count that chose it (2 %).
TEST(Scene, PointsSeeAsManyViewsAsAsked) {
  SceneOptions options;
  options.points = 100;
  options.samples_per_point = 48;
  const Scene scene = make_scene(options, studio_environment());
  EXPECT_NEAR(static_cast<double>(scene.path.sample_count()) / 100.0, 48.0, 1.0);
  // 40 % Lambert, 30 % GGX .60, 10 % each of the rest.
  EXPECT_EQ(only(scene.path, MaterialClass::lambert).points.size(), 40u);
  EXPECT_EQ(only(scene.path, MaterialClass::ggx60).points.size(), 30u);
  EXPECT_EQ(only(scene.path, MaterialClass::mix).points.size(), 10u);
  for (const StudyPoint& point : scene.path.points) {
    EXPECT_FALSE(point.test.empty());
    EXPECT_FALSE(point.training.empty());
  }
}

}  // namespace
}  // namespace sheen::evaluation
