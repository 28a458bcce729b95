// SPDX-License-Identifier: MIT
// What a correct comparison of billboard projections shows (docs/systems.md).
#include "evaluation/billboards/billboard_errors.h"

#include "capture/synthetic/torus_knot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sheen::evaluation {
namespace {

BillboardErrors errors_of(const BillboardImages& images, double view_deg, double bake_deg) {
  const core::Mesh mesh = capture::synthetic::torus_knot(3000);
  return billboard_errors(mesh, images, {view_deg}, {bake_deg}, 1, [](const std::string&) {})
      .front();
}

// E = 90 / d + 10 + 5 d: least where both ends are equal, sqrt(90 / 5).
TEST(ErrorLaw, IsFoundInFiguresThatFollowIt) {
  BillboardErrors errors{60, 0, {}, {}};
  for (std::size_t i = 0; i < kDistances.size(); ++i) {
    errors.average[i] = 90 / kDistances[i] + 10 + 5 * kDistances[i];
  }
  const ErrorLaw law = fit_law(errors);
  EXPECT_NEAR(law.parallax, 90, 1e-6);
  EXPECT_NEAR(law.constant, 10, 1e-6);
  EXPECT_NEAR(law.outline, 5, 1e-6);
  EXPECT_NEAR(law.best_distance(), std::sqrt(18.0), 1e-6);
}

// Hard outlines: parallax falls with distance, what outlines cost rises with their share of the
// image, so there is a least in between. The larger the images, the farther away.
TEST(BillboardErrors, HaveALeastInBetweenWithHardOutlines) {
  const auto errors = errors_of({64, 1}, 60, 0);
  const auto least = std::ranges::min_element(errors.average) - errors.average.begin();
  const double at = kDistances[static_cast<std::size_t>(least)];
  EXPECT_GE(at, 2);
  EXPECT_LE(at, 8);
  EXPECT_GT(errors.average.back(), 1.5 * *std::ranges::min_element(errors.average));
}

// Antialiased, only the parallax is left: the error of orthographic frames falls, and totals do.
TEST(BillboardErrors, FallWithDistanceWhenAntialiased) {
  const auto errors = errors_of({64, 2}, 60, 0);
  for (std::size_t i = 2; kDistances[i] <= 16; ++i) {
    EXPECT_LT(errors.average[i], errors.average[i - 1]) << kDistances[i];
  }
  EXPECT_TRUE(std::ranges::is_sorted(errors.total, std::ranges::greater()));
}

// Where a frame was baked only the 1 to 2.6 degrees to the nearest of 5,120 directions are left.
TEST(BillboardErrors, AreSmallWhereAFrameWasBaked) {
  const auto baked_here = errors_of({64, 2}, 60, 60);
  const auto orthographic = errors_of({64, 2}, 60, 0);
  EXPECT_LT(baked_here.average[1], 0.3 * orthographic.average[1]);
  EXPECT_GT(baked_here.average[3], orthographic.average[3]);
}

}  // namespace
}  // namespace sheen::evaluation
