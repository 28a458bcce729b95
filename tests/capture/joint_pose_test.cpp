// SPDX-License-Identifier: MIT
#include "capture/pose/joint_pose.h"

#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

namespace sheen::capture::test {
namespace {

constexpr unsigned kSeed = 7;

std::vector<TagDetection> exact_detections(const Board& board, const core::CameraModel& camera,
                                           const Eigen::Isometry3d& camera_from_board) {
  std::vector<TagDetection> detections;
  for (const auto& [id, corners] : true_corners(board, camera, camera_from_board)) {
    detections.push_back({id, corners, 1});
  }
  return detections;
}

struct PoseError {
  double position_m;
  double angle_deg;
};

PoseError compare(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const double angle = Eigen::AngleAxisd((a * b.inverse()).linear()).angle();
  return {(a.inverse().translation() - b.inverse().translation()).norm(),
          angle * 180 / std::numbers::pi};
}

class JointPoseOf : public testing::TestWithParam<bool> {
 protected:
  static Board make_board(bool bent) {
    Board board = make_grid_board("tag36h11", 5, 4, 0.045, 0.058);
    // A bent print, as the solvers for points not in one plane need it.
    for (auto& [id, tag] : board.tags) {
      if (bent) tag.board_from_tag.translation().z() = 0.03 * (id % 3);
    }
    return board;
  }
};

// Exact corners determine the pose; what remains is rounding of the iteration, far below a
// micrometre.
TEST_P(JointPoseOf, ExactCornersIsExact) {
  const Board board = make_board(GetParam());
  const core::CameraModel camera = make_camera(1280, 720, true);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::Isometry3d truth =
        look_at_board(0.4 + unit(random), 0.3 + 1.2 * unit(random), 6.28 * unit(random));
    const auto pose = estimate_joint_pose(board, camera, exact_detections(board, camera, truth));
    ASSERT_TRUE(pose) << "trial " << trial << " seed " << kSeed;
    const PoseError error = compare(pose->camera_from_board, truth);
    EXPECT_LT(error.position_m, 1e-7);
    EXPECT_LT(error.angle_deg, 1e-5);
    EXPECT_EQ(pose->tag_ids.size(), board.tags.size());
  }
}
INSTANTIATE_TEST_SUITE_P(Prints, JointPoseOf, testing::Bool());

// One tag of twenty moved by 10 px: it is dropped, so the others' exact pose returns.
TEST(JointPose, DropsATagThatIsOff) {
  const Board board = make_grid_board("tag36h11", 5, 4, 0.045, 0.058);
  const core::CameraModel camera = make_camera(1280, 720, true);
  const Eigen::Isometry3d truth = look_at_board(0.6, 0.9, 0.3);
  auto detections = exact_detections(board, camera, truth);
  for (Eigen::Vector2d& corner : detections[7].corners_px) corner += Eigen::Vector2d(8, 6);
  const auto pose = estimate_joint_pose(board, camera, detections);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->tag_ids.size(), 19U);
  EXPECT_EQ(std::count(pose->tag_ids.begin(), pose->tag_ids.end(), detections[7].id), 0);
  EXPECT_LT(compare(pose->camera_from_board, truth).position_m, 1e-6);
}

// Tags read as their neighbours are off by whole tags, more than a least-squares start survives.
TEST(JointPose, SurvivesTagsWithSwappedIds) {
  const Board board = make_grid_board("tag36h11", 4, 3, 0.045, 0.058);
  const core::CameraModel camera = make_camera(1280, 720, true);
  const Eigen::Isometry3d truth = look_at_board(0.6, 0.9, 0.3);
  auto detections = exact_detections(board, camera, truth);
  std::swap(detections[0].corners_px, detections[11].corners_px);
  std::swap(detections[2].corners_px, detections[5].corners_px);
  const auto pose = estimate_joint_pose(board, camera, detections);
  ASSERT_TRUE(pose);
  EXPECT_LT(compare(pose->camera_from_board, truth).position_m, 1e-6);
}

// When half of the tags stand elsewhere than the board says, dropping must not hide it: at most a
// third may go, the rest keep residuals of several pixels.
TEST(JointPose, DoesNotExplainAWrongBoardAway) {
  const Board board = make_grid_board("tag36h11", 4, 3, 0.045, 0.058);
  const core::CameraModel camera = make_camera(1280, 720, true);
  Board printed = board;
  for (auto& [id, tag] : printed.tags) {
    if (id % 2 == 0) tag.board_from_tag.translation().x() += 0.004 * (id % 4 == 0 ? 1 : -1);
  }
  const auto pose = estimate_joint_pose(
      board, camera, exact_detections(printed, camera, look_at_board(0.5, 1, 0.3)));
  ASSERT_TRUE(pose);
  EXPECT_GE(pose->tag_ids.size(), 8U);
  EXPECT_GT(pose->rms_px, 2);
}

TEST(JointPose, HasNoAnswerWithoutKnownTags) {
  const Board board = make_grid_board("tag36h11", 2, 2, 0.045, 0.058);
  const core::CameraModel camera = make_camera(640, 360, false);
  EXPECT_FALSE(estimate_joint_pose(board, camera, {}));
  TagDetection stranger{99, {{{10, 20}, {20, 20}, {20, 10}, {10, 10}}}, 1};
  EXPECT_FALSE(estimate_joint_pose(board, camera, {stranger}));
}

// All corners in one place: no pose or one whose residual says so, but no NaN.
TEST(JointPose, SurvivesCollapsedCorners) {
  const Board board = make_grid_board("tag36h11", 1, 1, 0.045, 0.058);
  TagDetection point{0, {}, 1};
  point.corners_px.fill({320, 180});
  const auto pose = estimate_joint_pose(board, make_camera(640, 360, false), {point});
  EXPECT_TRUE(!pose || pose->camera_from_board.matrix().allFinite());
}

}  // namespace
}  // namespace sheen::capture::test
