// SPDX-License-Identifier: MIT
// What a correct comparison of billboard projections shows (docs/systems.md).
#include "evaluation/billboards/billboard_errors.h"

#include "capture/synthetic/torus_knot.h"
#include "evaluation/comparison/smooth_path.h"
#include "fitting/descriptor.h"
#include "render/context/context.h"
#include "render/renderer.h"

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
  const auto errors = errors_of({64, 4}, 60, 0);
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

// From one nearest frame of 80 to the next everything moves at once; blended, frames come and go.
TEST(PopRatio, IsLargeForTheNearestBillboardAndSmallForBlendedOnes) {
  const core::Mesh mesh = capture::synthetic::torus_knot(3000);
  core::CameraModel::Intrinsics in;
  in.width_px = 160;
  in.height_px = 120;
  in.focal_px.setConstant(180);
  in.principal_px = {79.5, 59.5};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, 1, 0, 0, 0, -1, -1, 0, 0;  // from +x, z up
  pose.translation().z() = 0.4;
  const SmoothPath path =
      smooth_path(core::CameraModel(in), pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const auto context = render::make_osmesa_context();
  const auto ratio = [&](const char* blending) {
    const auto fitter = fitting::make_fitter(
        "billboard", mesh,
        {{"directions", "80"}, {"billboard-size", "64"}, {"billboard-blending", blending}});
    fitter->finish();
    const auto renderer = render::make_renderer(*context, mesh, fitter->light_field());
    return pop_ratio(*renderer, path);
  };
  EXPECT_GT(ratio("nearest"), 5);
  EXPECT_LT(ratio("blended"), 2);
}

}  // namespace
}  // namespace sheen::evaluation
