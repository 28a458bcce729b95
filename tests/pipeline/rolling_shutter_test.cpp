// SPDX-License-Identifier: MIT
// Frames whose rows are read one after the other, with motion that is known.
#include "capture/pose/rolling_shutter.h"

#include "capture/calibration/camera_file.h"
#include "capture/pose/tag_tracker.h"
#include "capture/pose/trajectory.h"
#include "capture/synthetic/synthetic_session.h"
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "core/visibility/raster_visibility.h"
#include "pipeline/observation_replay.h"
#include "pipeline/pose_frames.h"
#include "pipeline/pose_stage.h"
#include "pipeline/row_rectifier.h"
#include "pipeline/session_parts.h"
#include "pipeline/session_readout.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::pipeline {
namespace {

using capture::Twist;
using capture::test::look_at_board;

/// A pan with some travel: about 8 px across the middle of the image and 3 px down, from the first
/// row to the last (focal length 500 px, 0.45 m away).
const Twist kMotion = (Twist() << -4e-3, 12e-3, 6e-3, 2e-3, -1e-3, 1e-3).finished();

/// What a rolling shutter shows of a flat board: every pixel's ray meets the board at its row's own
/// time, and there the image of the middle row's time is read. Exact for motion of first order, and
/// none of the code under test takes this way.
cv::Mat rolled(const cv::Mat& global, const core::CameraModel& camera,
               const Eigen::Isometry3d& camera_from_board, const Twist& motion) {
  cv::Mat map(global.size(), CV_32FC2);
  for (int y = 0; y < map.rows; ++y) {
    const double share = (y + 0.5) / map.rows - 0.5;
    Eigen::Matrix3d turn;  // identity + share * [omega]
    turn << 1, -share * motion[2], share * motion[1], share * motion[2], 1, -share * motion[0],
        -share * motion[1], share * motion[0], 1;
    Eigen::Affine3d camera_from_board_then;
    camera_from_board_then.linear() = turn * camera_from_board.linear();
    camera_from_board_then.translation() =
        turn * camera_from_board.translation() + share * motion.tail<3>();
    const Eigen::Affine3d board_from_camera = camera_from_board_then.inverse();
    const Eigen::Vector3d eye = board_from_camera.translation();
    for (int x = 0; x < map.cols; ++x) {
      const Eigen::Vector3d ray =
          board_from_camera.linear() * camera.unproject(Eigen::Vector2d(x, y)).value();
      const Eigen::Vector3d on_board = eye - eye.z() / ray.z() * ray;
      const Eigen::Vector2d px = camera.project(camera_from_board * on_board).value();
      map.at<cv::Vec2f>(y, x) = {static_cast<float>(px.x()), static_cast<float>(px.y())};
    }
  }
  cv::Mat image;
  cv::remap(global, image, map, cv::noArray(), cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
  return image;
}

class RolledBoard : public testing::Test {
 protected:
  RolledBoard() {
    capture::test::Photograph photograph;
    photograph.noise = 2;
    global_ = render_board(board_, camera_, pose_, photograph);
    rolled_ = rolled(global_, camera_, pose_, kMotion);
  }

  static cv::Mat grey(const cv::Mat& image) {
    cv::Mat grey;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    return grey;
  }
  capture::TagTracker tracker() const {
    return {board_, camera_, capture::find_tag_family(board_.family, board_.border_bits).value()};
  }
  double position_error_mm(const Eigen::Isometry3d& camera_from_board) const {
    return 1e3 * (camera_from_board.inverse().translation() - pose_.inverse().translation()).norm();
  }
  /// How far a motion moves the tags' corners otherwise than the true one, px, RMS.
  double motion_error_px(const Twist& motion) const {
    double sum = 0;
    int corners = 0;
    for (const auto& [id, tag] : board_.tags) {
      for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
        const Eigen::Vector3d point = pose_ * corner;
        const auto seen = camera_.project(capture::when_its_row_is_read(camera_, motion, point));
        const auto truth = camera_.project(capture::when_its_row_is_read(camera_, kMotion, point));
        sum += (*seen - *truth).squaredNorm();
        ++corners;
      }
    }
    return std::sqrt(sum / corners);
  }

  capture::Board board_ = capture::test::make_grid_board("tag36h11", 5, 4, 0.045, 0.058);
  core::CameraModel camera_ = capture::test::make_camera(640, 360, true);
  Eigen::Isometry3d pose_ = look_at_board(0.45, 1.0, 0.4);
  cv::Mat global_, rolled_;
};

// A point is where its row's pose puts it: project what when_its_row_is_read says, and the row of
// that pixel gives the same point again.
TEST_F(RolledBoard, PointsLieWhereTheirRowsAreRead) {
  for (const auto& [id, tag] : board_.tags) {
    const Eigen::Vector3d point = pose_ * tag.board_from_tag.translation();
    const Eigen::Vector3d then = capture::when_its_row_is_read(camera_, kMotion, point);
    const double share = capture::row_share(camera_.project(then)->y(), 360);
    EXPECT_LT((capture::moved_by(kMotion, share, point) - then).norm(), 1e-7);  // 1e-4 px
  }
}

TEST(RollingShutter, TheTwistBetweenPosesTakesOneToTheOther) {
  const Eigen::Isometry3d from = look_at_board(0.45, 1.0, 0.4), to = look_at_board(0.5, 0.9, 0.5);
  EXPECT_TRUE(capture::moved(from, capture::twist_between(from, to)).isApprox(to, 1e-12));
  EXPECT_TRUE(capture::twist_between(from, from).isZero(1e-12));
}

// A hand's velocity is known to a tenth or so.
TEST_F(RolledBoard, TheTrackerFindsTheMotionOfOneFrame) {
  const auto pose =
      tracker().track(grey(rolled_), pose_, capture::ExpectedReadout{0.9 * kMotion, 1});
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->tags, 20);
  EXPECT_LT(pose->reprojection_px, 0.12);
  EXPECT_LT(motion_error_px(pose->readout_motion), 0.1);
  EXPECT_LT(position_error_mm(pose->camera_from_board), 0.5);

  // Nothing is known, as of a first frame: the corners fit, but a vertical motion and a tilt look
  // much alike.
  const auto first =
      tracker().track(grey(rolled_), pose_, capture::ExpectedReadout{Twist::Zero(), 5});
  ASSERT_TRUE(first);
  EXPECT_LT(first->reprojection_px, 0.12);
  EXPECT_LT(motion_error_px(first->readout_motion), 0.4);

  const auto as_one = tracker().track(grey(rolled_), pose_);
  ASSERT_TRUE(as_one);
  EXPECT_TRUE(as_one->readout_motion.isZero());
  EXPECT_GT(as_one->reprojection_px, 0.5);
  EXPECT_GT(position_error_mm(as_one->camera_from_board), 1);
}

// A global shutter's frame has no motion to be found: what is found is noise.
TEST_F(RolledBoard, OfAGlobalShutterNoMotionIsFound) {
  const auto pose =
      tracker().track(grey(global_), pose_, capture::ExpectedReadout{Twist::Zero(), 5});
  ASSERT_TRUE(pose);
  EXPECT_LT(motion_error_px(pose->readout_motion + kMotion), 0.1);
}

/// Root mean square difference of two images well inside, levels.
double difference(const cv::Mat& a, const cv::Mat& b) {
  const cv::Rect inside(24, 24, a.cols - 48, a.rows - 48);
  return cv::norm(a(inside), b(inside), cv::NORM_L2) /
         std::sqrt(3.0 * static_cast<double>(inside.area()));
}

// Rolling and rectifying are two interpolations by fractions of a pixel: 2 levels of noise and what
// they lose of edges of 175 levels. Unrectified, edges lie up to 4 px off.
TEST_F(RolledBoard, RectifyingUndoesRolling) {
  capture::Session session;
  session.camera = camera_;
  RowRectifier one(session, nullptr, 1), three(session, nullptr, 3);
  const capture::Frame frame{rolled_, 0, 0, grey(rolled_)};
  const capture::Frame rectified = one.rectify(frame, pose_, kMotion);
  EXPECT_GT(difference(rolled_, global_), 20);
  EXPECT_LT(difference(rectified.image, global_), 4);
  EXPECT_TRUE(rectified.grey.empty());
  EXPECT_EQ(cv::norm(three.rectify(frame, pose_, kMotion).image, rectified.image, cv::NORM_INF), 0);
  EXPECT_EQ(one.rectify(frame, pose_, Twist::Zero()).image.data, rolled_.data);
}

TEST(CameraFile, TellsTheReadout) {
  const tests::TemporaryFolder folder;
  const auto path = folder / "camera.yaml";
  auto intrinsics = capture::test::make_camera(640, 360, true).intrinsics();
  intrinsics.readout_s = -0.0165;
  capture::write_camera(path, core::CameraModel(intrinsics));
  EXPECT_DOUBLE_EQ(capture::read_camera(path).intrinsics().readout_s, -0.0165);

  std::string text = tests::read_file(path);
  text.replace(text.find("readout_ms"), std::string::npos, "readout_ms: 900.\n");
  tests::write_file(path, text);
  EXPECT_THROW(static_cast<void>(capture::read_camera(path)), core::Error);
}

class SyntheticShutter : public testing::Test {
 protected:
  capture::Session recorded(double readout_ms, capture::synthetic::PathKind path =
                                                   capture::synthetic::PathKind::turntable) const {
    capture::synthetic::SyntheticOptions options;
    options.path = path;
    options.vertices = 2000;
    options.width_px = 480;
    options.height_px = 270;
    options.frames = 60;
    options.held_out = 0;
    options.samples = 1;
    options.readout_ms = readout_ms;
    options.threads = 2;
    capture::synthetic::write_synthetic_session(folder_ / "session", options, {});
    return capture::open_session(folder_ / "session");
  }
  /// Median distance of cameras from where they were.
  static double median_error_mm(const capture::Session& session) {
    ProgressSink silent;
    const auto truth = capture::read_trajectory(session.folder / "truth_poses.txt");
    std::vector<double> errors;
    for (const PosedFrame& frame : pose_frames(session, {}, silent)) {
      const Eigen::Isometry3d& true_pose =
          truth.entries().at(static_cast<std::size_t>(frame.index)).board_from_camera;
      errors.push_back(
          1e3 * (frame.camera_from_board.inverse().translation() - true_pose.translation()).norm());
    }
    std::sort(errors.begin(), errors.end());
    return errors.at(errors.size() / 2);
  }
  tests::TemporaryFolder folder_;
};

// 6 degrees from frame to frame: the board's corners go 10 px while a frame is read.
TEST_F(SyntheticShutter, IsMeasuredAndPosesAreThoseOfTheMiddleRow) {
  capture::Session session = recorded(10);
  const auto readout = measure_readout(session, {});
  ASSERT_TRUE(readout);
  EXPECT_NEAR(readout->readout_s, 0.010, std::max(4 * readout->sigma_s, 0.0005));
  const double as_one_mm = median_error_mm(session);
  ProgressSink silent;
  complete_readout(session, {}, silent);
  EXPECT_LT(median_error_mm(session), as_one_mm / 3);
}

// A walk goes round steadily, so that a principal point elsewhere bends the tags of every frame
// alike, as a shutter would: 20 px passed for 2.4 +- 0.4 ms before corners were asked.
TEST_F(SyntheticShutter, AWrongPrincipalPointIsNotTakenForOne) {
  capture::Session session = recorded(0, capture::synthetic::PathKind::walk);
  auto intrinsics = session.camera.intrinsics();
  intrinsics.principal_px.x() += 20;
  session.camera = core::CameraModel(intrinsics);
  EXPECT_FALSE(measure_readout(session, {}));
}

// Undo and fitters of images see a frame again: to the bit as at first, wherever its pose has been
// refined to since.
TEST_F(SyntheticShutter, FramesAreRectifiedAgainAsAtFirst) {
  capture::Session session = recorded(10);
  auto intrinsics = session.camera.intrinsics();
  intrinsics.readout_s = 0.010;
  session.camera = core::CameraModel(intrinsics);
  const core::Mesh mesh = core::read_mesh(session.mesh);
  PoseStage poses(capture::open_frames(session, 0, 5), make_pose_estimator(session, {}, {}),
                  FrameCorrections(session, &mesh, 2));
  FrameStatistics frames;
  int rectified = 0;  // a frame that is searched may be posed by its corners, without motion
  std::vector<cv::Mat> images;
  std::vector<IntegratedView> views;
  while (const auto tracked = poses.next()) {
    const auto posed = frames.count(*tracked);
    ASSERT_TRUE(posed);
    rectified += posed->readout_motion.isZero() ? 0 : 1;
    images.push_back(tracked->frame.image);
    const Eigen::Isometry3d refined =
        posed->camera_from_board * Eigen::Translation3d(1e-4, 0, 0) * session.board_from_object;
    views.push_back({posed->index, refined, 1, *posed});
  }
  ViewObserver observer(mesh, core::make_raster_visibility(mesh, 1), {}, 1);
  std::size_t seen = 0;
  replay_observations(session, mesh, views, observer, nullptr, [&](const core::Observation& again) {
    EXPECT_EQ(cv::norm(again.image, images[seen], cv::NORM_INF), 0);
    ++seen;
  });
  EXPECT_EQ(seen, 5u);
  EXPECT_GE(rectified, 3);
}

TEST_F(SyntheticShutter, AGlobalOneIsLeftAlone) {
  capture::Session session = recorded(0);
  ProgressSink silent;
  complete_readout(session, {}, silent);
  EXPECT_EQ(session.camera.intrinsics().readout_s, 0);
}

}  // namespace
}  // namespace sheen::pipeline
