// SPDX-License-Identifier: MIT
// Silhouettes of a ball, known in closed form, to its visual hull.
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/silhouette/outline.h"
#include "reconstruction/silhouette/segmentation.h"
#include "tests/reconstruction/stage_for_tests.h"

#include <gtest/gtest.h>

namespace sheen::reconstruction {
namespace {

constexpr double kRadius_m = 0.03;
constexpr double kDistance_m = 0.4;
constexpr int kViews = 24;
const Eigen::Vector3d kCentre(0, 0, 0.05);

/// A ball in the middle of the image is a disc: its tangent cone has sin(half angle) = R / D, so
/// its radius in the plane z = 1 is R / sqrt(D^2 - R^2).
std::vector<OutlineVote> ball_outlines(const ViewSet& views) {
  const double radius_px = views.camera.intrinsics().focal_px.x() * kRadius_m /
                           std::sqrt(kDistance_m * kDistance_m - kRadius_m * kRadius_m);
  const Eigen::Vector2d middle = views.camera.intrinsics().principal_px;
  cv::Mat distance(views.camera.height_px(), views.camera.width_px(), CV_32FC1);
  for (int y = 0; y < distance.rows; ++y) {
    for (int x = 0; x < distance.cols; ++x) {
      distance.at<float>(y, x) =
          static_cast<float>(std::hypot(x - middle.x(), y - middle.y()) - radius_px);
    }
  }
  const cv::Mat sure(distance.size(), CV_8UC1, cv::Scalar(0));
  return std::vector<OutlineVote>(views.views.size(), {distance, sure});
}

struct BallHull {
  ViewSet views = tests::views_without_images(
      tests::small_camera(320, 240), tests::ring_of_poses(kViews, kDistance_m, 0, kCentre));
  std::vector<OutlineVote> outlines = ball_outlines(views);

  DistanceGrid carve(const CarvingVotes& votes, int threads = 1) const {
    const Eigen::Vector3f reach = Eigen::Vector3f::Constant(0.045F);
    const Eigen::Vector3f centre = kCentre.cast<float>();
    DistanceGrid grid({centre - reach, centre + reach}, 0.002F, 1);
    carve_hull(views, outlines, votes, nullptr, 0, threads, grid);
    return grid;
  }
};

TEST(VisualHull, OfABallLiesBetweenItAndTheClosedForm) {
  const DistanceGrid grid = BallHull().carve({});
  // Views lie in one plane through the centre. In a view's own middle plane its cone has the radius
  // D R / sqrt(D^2 - R^2) = 30.1 mm; straight up every view has that one. In the plane of the
  // views, 24 strips of that half width, 15 degrees apart, leave a regular 24-gon whose corners lie
  // 1 / cos(7.5 degrees) = 1.0086 farther out; cones widen behind the centre by at most R / D,
  // which at a tangent point is compensated by the view from the other side.
  const double cone_m =
      kDistance_m * kRadius_m / std::sqrt(kDistance_m * kDistance_m - kRadius_m * kRadius_m);
  const double corner_m = cone_m / std::cos(std::numbers::pi / kViews);
  const auto reach = [&](const Eigen::Vector3d& direction) {
    double r = 0.02;
    while (r < 0.044 && grid.value_at((kCentre + r * direction).cast<float>()) < 0) {
      r += 1e-5;
    }
    return r;
  };
  EXPECT_NEAR(reach({0, 0, 1}), cone_m, 2e-4);
  for (int i = 0; i < 48; ++i) {
    const double turn = 2 * std::numbers::pi * i / 48;
    const double r = reach({std::cos(turn), std::sin(turn), 0});
    EXPECT_GT(r, kRadius_m - 1e-4) << i;
    EXPECT_LT(r, corner_m + 4e-4) << i;
  }
}

TEST(VisualHull, BadSilhouettesAreOutvoted) {
  BallHull hull;
  const DistanceGrid good = hull.carve({.wrong = 3, .guesses_wrong = 3});
  // Two views that see nothing at all carve nothing while three must agree.
  for (const std::size_t v : {3U, 11U}) {
    hull.outlines[v].distance = cv::Mat(240, 320, CV_32FC1, cv::Scalar(50));
  }
  const DistanceGrid bad = hull.carve({.wrong = 3, .guesses_wrong = 3});
  const std::size_t middle = good.index(22, 22, 22);
  EXPECT_LT(bad[middle], 0);
  // Without tolerance nothing is left.
  EXPECT_TRUE(find_components(hull.carve({})).parts.empty());
}

TEST(VisualHull, GuessesNeedMoreVotes) {
  BallHull hull;
  for (const std::size_t v : {3U, 11U}) {
    hull.outlines[v].distance = cv::Mat(240, 320, CV_32FC1, cv::Scalar(50));
    hull.outlines[v].is_guessed = cv::Mat(240, 320, CV_8UC1, cv::Scalar(255));
  }
  EXPECT_TRUE(find_components(hull.carve({.wrong = 1, .guesses_wrong = 2})).parts.empty());
  EXPECT_EQ(find_components(hull.carve({.wrong = 1, .guesses_wrong = 3})).parts.size(), 1U);
}

TEST(VisualHull, ThreadsChangeNoBit) {
  const BallHull hull;
  const DistanceGrid one = hull.carve({});
  const DistanceGrid three = hull.carve({}, 3);
  for (std::size_t i = 0; i < one.count(); ++i) ASSERT_EQ(one[i], three[i]);
}

TEST(VisualHull, PartsAreNumberedBySize) {
  DistanceGrid grid({Eigen::Vector3f::Zero(), Eigen::Vector3f::Constant(9)}, 1, 1);
  for (const int x : {1, 5, 6}) grid[grid.index(x, 4, 4)] = -1;
  const Components parts = find_components(grid);
  ASSERT_EQ(parts.parts.size(), 2U);
  EXPECT_EQ(parts.parts[0].points, 2U);
  EXPECT_EQ(parts.of_point[grid.index(1, 4, 4)], 1);
  keep_components(parts, {0}, grid);
  EXPECT_GT(grid[grid.index(1, 4, 4)], 0);
  EXPECT_LT(grid[grid.index(5, 4, 4)], 0);
}

TEST(SilhouetteDistance, IsHalfAPixelAtTheOutlineAndDeepWhereUnknown) {
  cv::Mat labels(9, 9, CV_8UC1, cv::Scalar(static_cast<double>(PixelLabel::stage)));
  labels(cv::Rect(3, 3, 3, 3)).setTo(static_cast<double>(PixelLabel::object));
  labels.at<std::uint8_t>(0, 0) = static_cast<std::uint8_t>(PixelLabel::unknown);
  const cv::Mat d = silhouette_distance(labels);
  EXPECT_FLOAT_EQ(d.at<float>(4, 2), 0.5F);
  EXPECT_FLOAT_EQ(d.at<float>(4, 3), -0.5F);
  EXPECT_FLOAT_EQ(d.at<float>(4, 4), -1.5F);
  EXPECT_LT(d.at<float>(0, 0), -1000);
}

}  // namespace
}  // namespace sheen::reconstruction
