// SPDX-License-Identifier: MIT
#include "capture/pose/pose_estimator.h"
#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <cmath>

namespace sheen::capture::test {
namespace {

/// A board walked around, frame by frame.
class TrackingEstimator : public testing::Test {
 protected:
  static Photograph quick() {
    Photograph photograph;
    photograph.noise = 2;
    photograph.supersampling = 3;
    return photograph;
  }

  /// Frame `index` of a walk of 1.5 degrees a frame, starting at `azimuth`.
  [[nodiscard]] Eigen::Isometry3d pose_at(int index, double azimuth = 0.3) const {
    return look_at_board(0.5 - 0.002 * index, 1.0 + 0.01 * std::sin(index),
                         azimuth + 0.026 * index);
  }

  [[nodiscard]] Frame frame_at(int index, const Eigen::Isometry3d& pose) const {
    return {render_board(board_, camera_, pose, quick()), index / 30.0, index};
  }

  void expect_posed(const PoseResult& result, const Eigen::Isometry3d& truth) const {
    const auto* pose = std::get_if<FramePose>(&result);
    ASSERT_NE(pose, nullptr) << name_of(std::get<PoseRejection>(result));
    EXPECT_LT(
        (pose->camera_from_board.inverse().translation() - truth.inverse().translation()).norm(),
        2e-4);
  }

  Board board_ = make_grid_board("tag36h11", 4, 3, 0.06, 0.08);
  core::CameraModel camera_ = make_camera(640, 360, true);
  std::unique_ptr<PoseEstimator> estimator_ = make_tag_pose_estimator(board_, camera_, {});
};

TEST_F(TrackingEstimator, FollowsAWalk) {
  for (int i = 0; i < 6; ++i) {
    expect_posed(estimator_->estimate(frame_at(i, pose_at(i))), pose_at(i));
  }
}

// No frame is lost when the camera is turned to another place between two frames.
TEST_F(TrackingEstimator, RecoversInTheFrameOfAJump) {
  expect_posed(estimator_->estimate(frame_at(0, pose_at(0))), pose_at(0));
  expect_posed(estimator_->estimate(frame_at(1, pose_at(1))), pose_at(1));
  expect_posed(estimator_->estimate(frame_at(2, pose_at(2, 2.3))), pose_at(2, 2.3));
  expect_posed(estimator_->estimate(frame_at(3, pose_at(3, 2.3))), pose_at(3, 2.3));
}

TEST_F(TrackingEstimator, RecoversInTheFrameAfterDarkness) {
  expect_posed(estimator_->estimate(frame_at(0, pose_at(0))), pose_at(0));
  const PoseResult dark =
      estimator_->estimate({cv::Mat(360, 640, CV_8UC3, cv::Scalar::all(0)), 1 / 30.0, 1});
  ASSERT_TRUE(std::holds_alternative<PoseRejection>(dark));
  EXPECT_EQ(name_of(std::get<PoseRejection>(dark)), "no_tags");
  expect_posed(estimator_->estimate(frame_at(2, pose_at(2))), pose_at(2));
}

// A smear of 8 px rises from 10 to 90 % over 6.4 px: above the gate of 4. The next frame is sharp.
TEST_F(TrackingEstimator, RefusesASmearedFrameAndGoesOn) {
  expect_posed(estimator_->estimate(frame_at(0, pose_at(0))), pose_at(0));
  expect_posed(estimator_->estimate(frame_at(1, pose_at(1))), pose_at(1));
  Photograph smeared = quick();
  smeared.motion_px = 8;
  const PoseResult result =
      estimator_->estimate({render_board(board_, camera_, pose_at(2), smeared), 2 / 30.0, 2});
  ASSERT_TRUE(std::holds_alternative<PoseRejection>(result));
  EXPECT_EQ(name_of(std::get<PoseRejection>(result)), "blur");
  expect_posed(estimator_->estimate(frame_at(3, pose_at(3))), pose_at(3));
}

// The same frames give the same poses to the last bit, and a luma plane the same as its image.
TEST_F(TrackingEstimator, DependsOnTheFramesAlone) {
  const auto again = make_tag_pose_estimator(board_, camera_, {});
  for (int i = 0; i < 3; ++i) {
    Frame frame = frame_at(i, pose_at(i));
    const auto first = std::get<FramePose>(estimator_->estimate(frame));
    cv::cvtColor(frame.image, frame.grey, cv::COLOR_BGR2GRAY);
    frame.image.release();
    const auto second = std::get<FramePose>(again->estimate(frame));
    EXPECT_EQ(first.camera_from_board.matrix(), second.camera_from_board.matrix());
    EXPECT_EQ(first.reprojection_px, second.reprojection_px);
  }
}

// An image of another size fits no calibration: whatever comes back, nothing is read outside it,
// and the next good frame is posed.
TEST_F(TrackingEstimator, SurvivesAImageOfAnotherSize) {
  expect_posed(estimator_->estimate(frame_at(0, pose_at(0))), pose_at(0));
  const PoseResult small =
      estimator_->estimate({cv::Mat(90, 160, CV_8UC3, cv::Scalar::all(200)), 1 / 30.0, 1});
  EXPECT_TRUE(std::holds_alternative<PoseRejection>(small));
  expect_posed(estimator_->estimate(frame_at(2, pose_at(2))), pose_at(2));
}

}  // namespace
}  // namespace sheen::capture::test
