// SPDX-License-Identifier: MIT
#include "capture/pose/pose_estimator.h"

#include "capture/pose/blur.h"
#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace sheen::capture::test {
namespace {

const core::CameraModel kCamera = make_camera(640, 360, true);
const Eigen::Isometry3d kPose = look_at_board(0.5, 1.0, 0.4);

Board stage() {
  return make_grid_board("tag36h11", 5, 4, 0.045, 0.058);
}

PoseResult estimate(const Board& board, const cv::Mat& image, const PoseGate& gate = {}) {
  return make_tag_pose_estimator(board, kCamera, gate)->estimate({image, 0, 0});
}

void expect_refused(const PoseResult& result, PoseRejection reason) {
  ASSERT_TRUE(std::holds_alternative<PoseRejection>(result));
  EXPECT_EQ(name_of(std::get<PoseRejection>(result)), name_of(reason));
}

// The stated accuracy of the program on clean images of this size: 0.3 mm and 0.03 degrees.
TEST(TagPoseEstimator, FindsThePoseOfARenderedBoard) {
  std::vector<double> position_mm;
  std::vector<double> angle_deg;
  for (int view = 0; view < 5; ++view) {
    const Eigen::Isometry3d truth =
        look_at_board(0.5, (35 + 11 * view) * std::numbers::pi / 180, 1.3 * view);
    Photograph photograph;
    photograph.noise = 2;
    photograph.seed = static_cast<unsigned>(view) + 1;
    const auto result = estimate(stage(), render_board(stage(), kCamera, truth, photograph));
    ASSERT_TRUE(std::holds_alternative<FramePose>(result)) << "view " << view;
    const auto& pose = std::get<FramePose>(result);
    EXPECT_EQ(pose.tags, 20);
    EXPECT_LT(pose.reprojection_px, 0.2);
    const Eigen::Isometry3d error = pose.camera_from_board * truth.inverse();
    position_mm.push_back(
        1e3 *
        (pose.camera_from_board.inverse().translation() - truth.inverse().translation()).norm());
    angle_deg.push_back(Eigen::AngleAxisd(error.linear()).angle() * 180 / std::numbers::pi);
  }
  std::sort(position_mm.begin(), position_mm.end());
  std::sort(angle_deg.begin(), angle_deg.end());
  EXPECT_LT(position_mm[2], 0.3);
  EXPECT_LT(angle_deg[2], 0.03);
}

TEST(TagPoseEstimator, RefusesAImageWithoutTags) {
  expect_refused(estimate(stage(), cv::Mat(360, 640, CV_8UC3, cv::Scalar::all(180))),
                 PoseRejection::no_tags);
}

TEST(TagPoseEstimator, RefusesForeignTags) {
  Board foreign = make_grid_board("tag36h11", 2, 1, 0.045, 0.058);
  const cv::Mat image = render_board(foreign, kCamera, kPose, {});
  Board board = foreign;
  board.tags.clear();
  board.tags[300] = foreign.tags[0];
  expect_refused(estimate(board, image), PoseRejection::no_tags);
}

TEST(TagPoseEstimator, RefusesASingleTagWhereTwoAreAskedFor) {
  const Board one = make_grid_board("tag36h11", 1, 1, 0.09, 0.1);
  const cv::Mat image = render_board(one, kCamera, kPose, {});
  expect_refused(estimate(one, image), PoseRejection::too_few_tags);
  PoseGate gate;
  gate.min_tags = 1;
  EXPECT_TRUE(std::holds_alternative<FramePose>(estimate(one, image, gate)));
}

TEST(TagPoseEstimator, RefusesASmearedImage) {
  Board board = make_grid_board("tag36h11", 3, 2, 0.09, 0.115);
  Photograph photograph;
  photograph.motion_px = 8;
  // A smear of 8 px rises from 10 to 90 % over 6.4 px: above the gate of 4.
  expect_refused(estimate(board, render_board(board, kCamera, kPose, photograph)),
                 PoseRejection::blur);
}

TEST(TagPoseEstimator, RefusesAWrongBoard) {
  Board board = stage();
  for (auto& [id, tag] : board.tags) {
    tag.board_from_tag.translation().x() *= 1 + 0.1 * (id % 3);
  }
  expect_refused(estimate(board, render_board(stage(), kCamera, kPose, {})),
                 PoseRejection::reprojection);
}

// Closed form: a Gaussian blur of s rises from 10 to 90 % over 2.563 s. The pixel (a box of one
// pixel) and the bilinear read-out (a triangle of two) add 1/12 and 1/6 to the variance.
TEST(TagEdgeWidth, MeasuresAGaussianBlur) {
  const Board board = make_grid_board("tag36h11", 2, 1, 0.14, 0.18);
  const core::CameraModel camera = make_camera(640, 360, false);
  const Eigen::Isometry3d pose = look_at_board(0.5, 1.5, std::numbers::pi / 2);
  std::vector<TagDetection> tags;
  for (const auto& [id, corners] : true_corners(board, camera, pose))
    tags.push_back({id, corners, 1});
  for (const double sigma : {1.0, 1.5, 2.0}) {
    Photograph photograph;
    photograph.blur_sigma_px = sigma;
    cv::Mat grey;
    cv::cvtColor(render_board(board, camera, pose, photograph), grey, cv::COLOR_BGR2GRAY);
    const double expected = 2.563 * std::sqrt(sigma * sigma + 1.0 / 12 + 1.0 / 6);
    const auto width = tag_edge_width(grey, camera, 8, tags);
    ASSERT_TRUE(width);
    EXPECT_NEAR(*width, expected, 0.08 * expected);
  }
}

TEST(TagEdgeWidth, HasNoAnswerWithoutEdges) {
  const cv::Mat grey(100, 100, CV_8U, cv::Scalar(128));
  const TagDetection tag{0, {{{20, 80}, {80, 80}, {80, 20}, {20, 20}}}, 1};
  EXPECT_FALSE(tag_edge_width(grey, make_camera(100, 100, false), 8, {tag}));
  EXPECT_FALSE(tag_edge_width(grey, make_camera(100, 100, false), 8, {}));
}

TEST(RecordedPoseEstimator, ReturnsThePoseInverted) {
  Trajectory::Entry entry;
  entry.stamp = 3;
  entry.board_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  const auto estimator = make_recorded_pose_estimator(Trajectory({entry}), 30);
  const auto result = estimator->estimate({cv::Mat(), 0.1, 3});
  ASSERT_TRUE(std::holds_alternative<FramePose>(result));
  // The inverse of a translation is the opposite one.
  EXPECT_TRUE(std::get<FramePose>(result).camera_from_board.translation().isApprox(
      Eigen::Vector3d(-1, -2, -3)));
  expect_refused(estimator->estimate({cv::Mat(), 0.1, 4}), PoseRejection::no_pose_in_file);
}

TEST(PoseGate, RefusesValuesOutOfRange) {
  EXPECT_NO_THROW(PoseGate{}.check());
  EXPECT_THROW((PoseGate{.min_tags = 0}.check()), std::invalid_argument);
  EXPECT_THROW((PoseGate{.max_reprojection_px = 0}.check()), std::invalid_argument);
  EXPECT_THROW((PoseGate{.max_blur_px = std::nan("")}.check()), std::invalid_argument);
}

}  // namespace
}  // namespace sheen::capture::test
