// SPDX-License-Identifier: MIT
#include "render/surface/view_block.h"

#include "render/surface/invalid_ray_mask.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sheen::render {
namespace {

TEST(LongestStraightSegment, IsInfiniteWithoutDistortion) {
  EXPECT_TRUE(std::isinf(longest_straight_segment(testing::plain_camera(640, 480))));
}

// One radial coefficient k: the radial map r + k r^3 has second derivative 6 k r, largest where the
// image's corner looks. Along x at (R, 0) it is 6 k R; on the grid's rim nothing bends more.
TEST(LongestStraightSegment, ClosedFormForOneCoefficient) {
  core::CameraModel::Intrinsics in = testing::plain_camera(640, 480).intrinsics();
  in.principal_px = {319.5, 239.5};
  in.distortion[0] = 0.1;
  const core::CameraModel camera(in);
  const double corner = camera.unproject({-0.5, -0.5})->head<2>().norm();
  const double expected = std::sqrt(8 * kSagittaLimitPx / (in.focal_px.x() * 6 * 0.1 * corner));
  EXPECT_NEAR(longest_straight_segment(camera), expected, 0.01 * expected);
}

// What the limit promises: the middle of a segment of that length is seen at most kSagittaLimitPx
// beside the straight line between its ends, here measured on segments all over the image.
TEST(LongestStraightSegment, KeepsItsPromise) {
  const core::CameraModel camera = testing::distorted_camera(640, 480);
  const double s = longest_straight_segment(camera);
  double worst = 0;
  for (double x = 8; x < 632; x += 13) {
    for (double y = 8; y < 472; y += 13) {
      const Eigen::Vector3d middle = *camera.unproject({x, y});
      for (double angle = 0; angle < 3.1; angle += 0.4) {
        const Eigen::Vector3d half = s / 2 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        const auto a = camera.project(middle - half);
        const auto b = camera.project(middle + half);
        worst = std::max(worst, (0.5 * (*a + *b) - Eigen::Vector2d(x, y)).norm());
      }
    }
  }
  EXPECT_LE(worst, 1.05 * kSagittaLimitPx);
  // And it is no shorter than it must be by more than a factor of two in length.
  EXPECT_GE(worst, 0.25 * kSagittaLimitPx);
}

TEST(InvalidRayMask, EmptyForCamerasWhoseCornersSee) {
  InvalidRayMask invalid;
  EXPECT_TRUE(invalid.of(testing::distorted_camera(64, 48)).empty());
}

// r (1 - 0.4 r^2) grows up to r = 1 / sqrt(1.2), where it is 0.6086: with a focal length of 40
// pixels everything beyond 24.3 pixels from the centre is invalid.
TEST(InvalidRayMask, ClosedFormForABarrelThatFoldsBack) {
  core::CameraModel::Intrinsics in = testing::plain_camera(65, 65).intrinsics();
  in.focal_px = {40, 40};
  in.distortion[0] = -0.4;
  InvalidRayMask invalid;
  const cv::Mat mask = invalid.of(core::CameraModel(in));
  ASSERT_FALSE(mask.empty());
  for (int y = 0; y < 65; ++y) {
    for (int x = 0; x < 65; ++x) {
      const double radius = std::hypot(x - 32, y - 32);
      if (std::abs(radius - 24.34) < 0.2) continue;  // the fold itself, where Newton may fail
      EXPECT_EQ(mask.at<std::uint8_t>(y, x) != 0, radius > 24.34) << x << " " << y;
    }
  }
  EXPECT_TRUE(invalid.of(testing::plain_camera(65, 65)).empty());
}

}  // namespace
}  // namespace sheen::render
