// SPDX-License-Identifier: MIT
// The tags' places from the images: displaced tags found again from projected corners.
#include "capture/pose/board_refinement.h"

#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace sheen::capture::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Corners of every tag of `board` as an ideal camera sees them from `count` places around it.
std::vector<std::vector<TagDetection>> ideal_views(const Board& board,
                                                   const core::CameraModel& camera, int count) {
  std::vector<std::vector<TagDetection>> views;
  for (int i = 0; i < count; ++i) {
    const auto pose = look_at_board(0.45 + 0.02 * (i % 3), (45 + 4 * (i % 5)) * kDegree,
                                    2 * std::numbers::pi * i / count);
    std::vector<TagDetection> tags;
    for (const auto& [id, corners] : true_corners(board, camera, pose)) {
      tags.push_back({id, corners, 1.0});
    }
    views.push_back(std::move(tags));
  }
  return views;
}

/// The board with every tag moved by about `shift_m` in each direction and turned a little.
Board displaced(const Board& board, double shift_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Board result = board;
  for (auto& [id, tag] : result.tags) {
    const Eigen::Vector3d shift(normal(random), normal(random), normal(random));
    const Eigen::Vector3d axis =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    tag.board_from_tag.translation() += shift_m * shift;
    tag.board_from_tag.rotate(Eigen::AngleAxisd(0.3 * kDegree * normal(random), axis));
  }
  return result;
}

/// Largest distance of a corner of `a` from the same corner of `b` after the similarity that lays
/// all of `a` on `b` best: what a choice of frame and scale cannot explain.
double largest_difference_m(const Board& a, const Board& b) {
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(4 * a.tags.size()));
  Eigen::Matrix3Xd to(3, from.cols());
  Eigen::Index column = 0;
  for (const auto& [id, tag] : a.tags) {
    for (int c = 0; c < 4; ++c, ++column) {
      from.col(column) = tag.corners_in_board()[static_cast<std::size_t>(c)];
      to.col(column) = b.tags.at(id).corners_in_board()[static_cast<std::size_t>(c)];
    }
  }
  const Eigen::Affine3d motion(Eigen::umeyama(from, to, true));
  return ((motion * from) - to).colwise().norm().maxCoeff();
}

TEST(BoardRefinement, FindsDisplacedTagsToMachinePrecisionWithoutNoise) {
  const unsigned seed = 3;
  SCOPED_TRACE(seed);
  const auto camera = make_camera(1280, 720, true);
  const Board given = make_grid_board("tag36h11", 4, 3, 0.03, 0.045);
  const Board truth = displaced(given, 0.0005, seed);
  const auto refinement = refine_board(given, camera, ideal_views(truth, camera, 16));
  ASSERT_TRUE(refinement);
  EXPECT_EQ(refinement->views, 16);
  EXPECT_EQ(refinement->tags, 12);
  // Displaced by 0.5 mm at 0.45 m and a focal length of about 1000 px: about 1 px and more.
  EXPECT_GT(refinement->rms_before_px, 0.5);
  EXPECT_LT(refinement->rms_after_px, 1e-6);
  EXPECT_GT(largest_difference_m(given, truth), 5e-4);
  EXPECT_LT(largest_difference_m(refinement->board, truth), 1e-9);
}

TEST(BoardRefinement, FindsTheLensWithTheTags) {
  // Exact corners of displaced tags through one lens, explained at first through another: both the
  // tags and the lens come back. The board's own scale is held by the layout, so 1e-4 is what is
  // left of an unknown scale of the displaced tags (0.5 mm over 180 mm and 48 corners).
  const unsigned seed = 7;
  SCOPED_TRACE(seed);
  const auto truth = make_camera(1280, 720, true);
  const Board given = make_grid_board("tag36h11", 4, 3, 0.03, 0.045);
  auto wrong = truth.intrinsics();
  wrong.focal_px *= 1.01;
  wrong.principal_px += Eigen::Vector2d(4, -3);
  wrong.distortion[0] += 0.02;
  const auto views = ideal_views(displaced(given, 0.0005, seed), truth, 16);
  const auto fixed = refine_board(given, core::CameraModel(wrong), views);
  const auto refined = refine_board(given, core::CameraModel(wrong), views, LensRefinement::on);
  ASSERT_TRUE(fixed && refined);
  EXPECT_LT(refined->rms_after_px, 1e-3);
  EXPECT_GT(fixed->rms_after_px, 100 * refined->rms_after_px);
  const auto& found = refined->camera.intrinsics();
  EXPECT_LT((found.focal_px - truth.intrinsics().focal_px).norm(), 0.1);
  EXPECT_LT((found.principal_px - truth.intrinsics().principal_px).norm(), 0.1);
  EXPECT_EQ(found.distortion[5], 0) << "terms the given lens lacks stay out";
}

TEST(BoardRefinement, FindsCurledPaper) {
  // A sheet bent to an arc of 1.5 m: 3 mm at the rim of 190 mm; tags follow it in height and tilt.
  const auto camera = make_camera(1280, 720, true);
  const Board flat = make_grid_board("tag36h11", 5, 3, 0.03, 0.04);
  Board curled = flat;
  for (auto& [id, tag] : curled.tags) {
    const double angle = tag.board_from_tag.translation().x() / 1.5;
    tag.board_from_tag.translation().x() = 1.5 * std::sin(angle);
    tag.board_from_tag.translation().z() = 1.5 * (1 - std::cos(angle));
    tag.board_from_tag.rotate(Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()));
  }
  const auto refinement = refine_board(flat, camera, ideal_views(curled, camera, 16));
  ASSERT_TRUE(refinement);
  EXPECT_GT(refinement->rms_before_px, 1);
  EXPECT_LT(refinement->rms_after_px, 1e-6);
  EXPECT_LT(largest_difference_m(refinement->board, curled), 1e-8);
}

TEST(BoardRefinement, KeepsTheBoardFrameOfTheGivenBoard) {
  // The refined corners lie on the given ones as well as any similarity can lay them: no mean
  // shift is left.
  const unsigned seed = 4;
  SCOPED_TRACE(seed);
  const auto camera = make_camera(1280, 720, true);
  const Board given = make_grid_board("tag36h11", 4, 3, 0.03, 0.045);
  const auto refinement =
      refine_board(given, camera, ideal_views(displaced(given, 0.0005, seed), camera, 16));
  ASSERT_TRUE(refinement);
  Eigen::Vector3d mean_shift = Eigen::Vector3d::Zero();
  for (const auto& [id, tag] : given.tags) {
    const auto before = tag.corners_in_board();
    const auto after = refinement->board.tags.at(id).corners_in_board();
    for (std::size_t c = 0; c < 4; ++c) mean_shift += after[c] - before[c];
  }
  EXPECT_LT(mean_shift.norm() / 48, 1e-12);
}

TEST(BoardRefinement, LeavesAPerfectBoardWhereItIs) {
  const auto camera = make_camera(1280, 720, true);
  const Board given = make_grid_board("tag36h11", 3, 3, 0.03, 0.045);
  const auto refinement = refine_board(given, camera, ideal_views(given, camera, 8));
  ASSERT_TRUE(refinement);
  EXPECT_LT(refinement->median_shift_m, 1e-9);
}

TEST(BoardRefinement, LooksPastAFewWrongCorners) {
  // One corner of every tenth tag is 15 px off. Huber at 1 px leaves each a pull of at most a pixel
  // among the corners of 16 views: below 0.1 mm against the 0.5 mm displaced.
  const unsigned seed = 5;
  SCOPED_TRACE(seed);
  const auto camera = make_camera(1280, 720, true);
  const Board given = make_grid_board("tag36h11", 4, 3, 0.03, 0.045);
  const Board truth = displaced(given, 0.0005, seed);
  auto views = ideal_views(truth, camera, 16);
  int counter = 0;
  for (auto& view : views) {
    for (auto& tag : view) {
      if (counter++ % 10 == 0) tag.corners_px[1].x() += 15;
    }
  }
  const auto refinement = refine_board(given, camera, views);
  ASSERT_TRUE(refinement);
  EXPECT_LT(largest_difference_m(refinement->board, truth), 1e-4);
}

TEST(BoardRefinement, LeavesTagsSeenTooRarelyInPlace) {
  const auto camera = make_camera(1280, 720, false);
  const Board given = make_grid_board("tag36h11", 3, 3, 0.03, 0.045);
  auto views = ideal_views(displaced(given, 0.0005, 6), camera, 8);
  const int rare_id = given.tags.begin()->first;
  for (std::size_t i = 2; i < views.size(); ++i) {
    std::erase_if(views[i], [&](const TagDetection& tag) { return tag.id == rare_id; });
  }
  const auto refinement = refine_board(given, camera, views);
  ASSERT_TRUE(refinement);
  EXPECT_EQ(refinement->tags, 8);
  EXPECT_TRUE(refinement->board.tags.at(rare_id).board_from_tag.isApprox(
      given.tags.at(rare_id).board_from_tag, 0));
}

TEST(BoardRefinement, HasNoAnswerWithoutTagsSeenTogether) {
  const auto camera = make_camera(1280, 720, false);
  const Board given = make_grid_board("tag36h11", 3, 3, 0.03, 0.045);
  EXPECT_FALSE(refine_board(given, camera, {}));
  auto views = ideal_views(given, camera, 8);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].assign(1, views[i][i]);
  EXPECT_FALSE(refine_board(given, camera, views)) << "one tag a view";
}

}  // namespace
}  // namespace sheen::capture::test
