// SPDX-License-Identifier: MIT
#include "capture/pose/tag_tracker.h"

#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <numbers>
#include <ostream>
#include <set>

namespace sheen::capture::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

cv::Mat grey_image(const Board& board, const core::CameraModel& camera,
                   const Eigen::Isometry3d& camera_from_board, const Photograph& photograph) {
  cv::Mat grey;
  cv::cvtColor(render_board(board, camera, camera_from_board, photograph), grey,
               cv::COLOR_BGR2GRAY);
  return grey;
}

TagTracker make_tracker(const Board& board, const core::CameraModel& camera) {
  return {board, camera, find_tag_family(board.family, board.border_bits).value()};
}

/// A prediction that is off: turned and moved by what a hand does between two frames.
Eigen::Isometry3d disturbed(const Eigen::Isometry3d& camera_from_board, double degrees,
                            double metres) {
  Twist twist;
  twist.head<3>() = degrees * kDegree * Eigen::Vector3d(0.6, -0.64, 0.48);
  twist.tail<3>() = metres * Eigen::Vector3d(-0.48, 0.6, 0.64);
  return moved(camera_from_board, twist);
}

double position_error_mm(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  return 1e3 * (estimate.inverse().translation() - truth.inverse().translation()).norm();
}

double angle_error_deg(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  return Eigen::AngleAxisd((estimate * truth.inverse()).linear()).angle() / kDegree;
}

double corner_rms_px(const std::vector<MeasuredCorner>& corners,
                     const std::map<int, std::array<Eigen::Vector2d, 4>>& truth) {
  double sum = 0;
  for (const MeasuredCorner& corner : corners) {
    sum += (corner.px - truth.at(corner.tag_id)[static_cast<std::size_t>(corner.corner)])
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(corners.size()));
}

std::set<int> ids_of(const std::vector<MeasuredCorner>& corners) {
  std::set<int> ids;
  for (const MeasuredCorner& corner : corners) ids.insert(corner.tag_id);
  return ids;
}

/// The image that most tests follow: 20 tags, a distorted lens, noise.
class TrackedStage : public testing::Test {
 protected:
  static Photograph noisy() {
    Photograph photograph;
    photograph.noise = 3;
    return photograph;
  }
  static Board stage() { return make_grid_board("tag36h11", 5, 4, 0.045, 0.058); }

  core::CameraModel camera_ = make_camera(640, 360, true);
  Eigen::Isometry3d pose_ = look_at_board(0.45, 1.0, 0.4);
  TagTracker tracker_ = make_tracker(stage(), camera_);
};

// The goal of the program: measured corners within 0.06 px of OpenCV's projections, root mean
// square. The prediction is 1 degree and 6 mm off, which moves tags by 14 to 25 px.
TEST(TagTracker, MeasuresCornersOf24TagsToATwentiethOfAPixel) {
  const Board board = make_grid_board("tag36h11", 6, 4, 0.045, 0.058);
  const core::CameraModel camera = make_camera(1280, 720, true);
  const Eigen::Isometry3d truth = look_at_board(0.5, 0.9, 0.7);
  Photograph photograph;
  photograph.blur_sigma_px = 0.7;
  photograph.noise = 3;
  const cv::Mat grey = grey_image(board, camera, truth, photograph);
  TagTracker tracker = make_tracker(board, camera);
  const auto pose = tracker.track(grey, disturbed(truth, 1, 0.006));
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->tags, 24);
  EXPECT_LE(corner_rms_px(tracker.corners(), true_corners(board, camera, truth)), 0.06);
  // 96 corners of 0.06 px at 1000 px focal length and 0.5 m: some 0.06 / sqrt(96) 0.5 mm across,
  // ten times more where the board is seen from the side.
  EXPECT_LT(position_error_mm(pose->camera_from_board, truth), 0.03);
  EXPECT_LT(angle_error_deg(pose->camera_from_board, truth), 0.005);
}

// What the tracker reports of its fit is what its corners say.
TEST_F(TrackedStage, ReportsTheResidualsOfItsCorners) {
  const auto pose = tracker_.track(grey_image(stage(), camera_, pose_, noisy()), pose_);
  ASSERT_TRUE(pose);
  const auto projected = true_corners(stage(), camera_, pose->camera_from_board);
  EXPECT_NEAR(pose->reprojection_px, corner_rms_px(tracker_.corners(), projected), 1e-9);
}

// A camera's tone curve moves the middle of every blurred edge: paper grows over ink, by a third of
// a pixel here. All of that must go into the swell, which does not move the camera.
TEST_F(TrackedStage, ToneCurvesDoNotMoveTheCamera) {
  Photograph photograph;
  photograph.blur_sigma_px = 1;
  const cv::Mat linear = grey_image(stage(), camera_, pose_, photograph);
  cv::Mat curve(1, 256, CV_8U);
  for (int v = 0; v < 256; ++v) {
    curve.at<unsigned char>(v) =
        cv::saturate_cast<unsigned char>(255 * std::pow(v / 255.0, 1 / 2.2));
  }
  cv::Mat bent;
  cv::LUT(linear, curve, bent);
  const auto from_linear = tracker_.track(linear, pose_);
  const auto from_bent = tracker_.track(bent, pose_);
  ASSERT_TRUE(from_linear && from_bent);
  EXPECT_GT(from_bent->reprojection_px, 0.2);  // the corners show it
  // Taken for a change of distance, a third of a pixel on tags of 45 px at 0.45 m is up to
  // 2 x 0.33 / 45 x 450 = 6.6 mm for one tag and some tenths of a millimetre for the whole board.
  EXPECT_LT(position_error_mm(from_bent->camera_from_board, from_linear->camera_from_board), 0.1);
}

// A hand: a dark arm with bright fingers over the middle of the board.
TEST_F(TrackedStage, PassesOverCoveredTags) {
  cv::Mat grey = grey_image(stage(), camera_, pose_, noisy());
  cv::ellipse(grey, {320, 250}, {70, 120}, 20, 0, 360, cv::Scalar(70), cv::FILLED);
  for (int finger = 0; finger < 4; ++finger) {
    cv::line(grey, {280 + 25 * finger, 190}, {250 + 40 * finger, 100}, cv::Scalar(190), 14);
  }
  const auto pose = tracker_.track(grey, disturbed(pose_, 0.5, 0.003));
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->tags, 18);
  EXPECT_GE(pose->tags, 8);
  EXPECT_LT(position_error_mm(pose->camera_from_board, pose_), 0.1);
  EXPECT_LT(angle_error_deg(pose->camera_from_board, pose_), 0.015);
}

TEST_F(TrackedStage, UsesTagsThatTheImageCuts) {
  const Eigen::Isometry3d close = look_at_board(0.2, 1.1, 0.4);
  const auto pose =
      tracker_.track(grey_image(stage(), camera_, close, noisy()), disturbed(close, 0.5, 0.002));
  ASSERT_TRUE(pose);
  // Some tag has corners in the image and corners outside.
  std::map<int, int> corners;
  for (const MeasuredCorner& corner : tracker_.corners()) ++corners[corner.tag_id];
  EXPECT_TRUE(
      std::any_of(corners.begin(), corners.end(), [](const auto& tag) { return tag.second < 4; }));
  EXPECT_LT(position_error_mm(pose->camera_from_board, close), 0.1);
  EXPECT_LT(angle_error_deg(pose->camera_from_board, close), 0.02);
}

// Tag 12 has been pasted over with tag 99, 3 mm beside its place: its outline would pull the pose.
TEST_F(TrackedStage, RefusesAPastedTagByItsCode) {
  Board pasted = stage();
  pasted.tags[99] = pasted.tags.at(12);
  pasted.tags[99].board_from_tag.translation().x() += 0.003;
  pasted.tags.erase(12);
  const auto pose = tracker_.track(grey_image(pasted, camera_, pose_, noisy()), pose_);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->tags, 19);
  EXPECT_FALSE(ids_of(tracker_.corners()).contains(12));
  EXPECT_LT(position_error_mm(pose->camera_from_board, pose_), 0.1);
}

// A Gaussian blur of 2 px rises over 2.563 sqrt(4 + 1/12 + 1/6) = 5.3 px (pixel and read-out
// included), a module here is about 10 px high. Corners stay within a tenth of the blur.
TEST(TagTracker, MeasuresBlur) {
  const Board board = make_grid_board("tag36h11", 3, 2, 0.09, 0.115);
  const core::CameraModel camera = make_camera(640, 360, true);
  const Eigen::Isometry3d truth = look_at_board(0.5, 1.2, 0.4);
  Photograph photograph;
  photograph.blur_sigma_px = 2;
  TagTracker tracker = make_tracker(board, camera);
  const auto pose =
      tracker.track(grey_image(board, camera, truth, photograph), disturbed(truth, 0.5, 0.002));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->blur_px, 5.3, 0.5);
  EXPECT_LT(corner_rms_px(tracker.corners(), true_corners(board, camera, truth)), 0.2);
}

TEST_F(TrackedStage, HasNoAnswerWhereTheBoardIsNot) {
  EXPECT_FALSE(tracker_.track(cv::Mat(360, 640, CV_8U, cv::Scalar(0)), pose_));
  cv::Mat noise(360, 640, CV_8U);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  EXPECT_FALSE(tracker_.track(noise, pose_));
  // The board, but half a board's width away from where it is predicted.
  const cv::Mat grey = grey_image(stage(), camera_, pose_, noisy());
  EXPECT_FALSE(tracker_.track(grey, look_at_board(0.45, 1.0, 2.0)));
  // Behind the camera.
  EXPECT_FALSE(tracker_.track(grey, look_at_board(-0.45, 1.0, 0.4)));
}

TEST_F(TrackedStage, HasNoAnswerForAImageOfAnotherSize) {
  const cv::Mat grey = grey_image(stage(), camera_, pose_, noisy());
  EXPECT_FALSE(tracker_.track(grey(cv::Rect(0, 0, 320, 180)), pose_));
  EXPECT_FALSE(tracker_.track(cv::Mat(1, 1, CV_8U, cv::Scalar(0)), pose_));
}

struct TrackedPrint {
  const char* family;
  int border_bits;
};
void PrintTo(const TrackedPrint& print, std::ostream* out) {
  *out << print.family << ", border " << print.border_bits;
}

class EveryTrackedFamily : public testing::TestWithParam<TrackedPrint> {};

TEST_P(EveryTrackedFamily, IsFollowed) {
  Board board = make_grid_board(GetParam().family, 3, 2, 0.09, 0.17);
  board.border_bits = GetParam().border_bits;
  const core::CameraModel camera = make_camera(640, 360, true);
  const Eigen::Isometry3d truth = look_at_board(0.75, 1.1, 0.1);
  const cv::Mat grey = grey_image(board, camera, truth, {});
  TagTracker tracker = make_tracker(board, camera);
  const auto pose = tracker.track(grey, disturbed(truth, 0.3, 0.002));
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->tags, 6);
  EXPECT_LE(corner_rms_px(tracker.corners(), true_corners(board, camera, truth)), 0.06);
}
INSTANTIATE_TEST_SUITE_P(TrackedPrint, EveryTrackedFamily,
                         testing::Values(TrackedPrint{"tag36h11", 1}, TrackedPrint{"tag16h5", 1},
                                         TrackedPrint{"tagStandard41h12", 1},
                                         TrackedPrint{"tagCircle21h7", 1},
                                         TrackedPrint{"tag36h11", 2},
                                         TrackedPrint{"DICT_6X6_250", 1},
                                         TrackedPrint{"DICT_4X4_50", 2}));

}  // namespace
}  // namespace sheen::capture::test
