// SPDX-License-Identifier: MIT
#include "capture/pose/board_refinement.h"
#include "capture/pose/board_tags.h"
#include "capture/pose/joint_pose.h"
#include "capture/pose/pose_estimator.h"
#include "capture/pose/tag_detector.h"
#include "capture/registration/registration.h"
#include "capture/session/session.h"
#include "core/mesh/read_mesh.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

namespace sheen::capture::test {
namespace {

const std::filesystem::path kData = SHEEN_SHARED_DATA;

#define SKIP_WITHOUT(folder)                                                   \
  if (!std::filesystem::exists(folder)) {                                      \
    GTEST_SKIP() << "the recording " << (folder) << " is not on this machine"; \
  }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Errors {
  std::vector<double> position_mm, angle_deg;
  void add(const Eigen::Isometry3d& camera_from_board, const Eigen::Isometry3d& board_from_camera) {
    position_mm.push_back(
        1e3 * (camera_from_board.inverse().translation() - board_from_camera.translation()).norm());
    const Eigen::Isometry3d error = camera_from_board * board_from_camera;
    angle_deg.push_back(Eigen::AngleAxisd(error.linear()).angle() * 180 / std::numbers::pi);
  }
};

class PhotographsOf : public testing::TestWithParam<const char*> {
 protected:
  /// Every fifth image is enough for a median and keeps the test short.
  template <typename Use>
  static void for_each_frame(const Session& session, const Use& use) {
    const auto source = open_frames(session);
    while (const auto frame = source->next()) {
      if (frame->index % 5 == 0) use(*frame);
    }
  }
};

// The board file comes from a bundle adjustment over OpenCV's own corners. Joint PnP over the same
// kind of corners must give that adjustment's poses back: 0.1 mm and 0.01 degrees.
TEST_P(PhotographsOf, JointPoseAgreesWithTheAdjustment) {
  SKIP_WITHOUT(kData / GetParam());
  const Session session = open_session(kData / GetParam());
  const Board board = read_board(session.board.value());
  const Trajectory truth = read_trajectory(session.poses.value());
  const TagDetector detector(find_tag_family(board.family, board.border_bits).value());
  Errors errors;
  for_each_frame(session, [&](const Frame& frame) {
    cv::Mat grey;
    cv::cvtColor(frame.image, grey, cv::COLOR_BGR2GRAY);
    const auto pose =
        estimate_joint_pose(board, session.camera, drop_ambiguous(detector.detect(grey)));
    ASSERT_TRUE(pose) << "frame " << frame.index;
    errors.add(pose->camera_from_board, truth.board_from_camera(frame, 30).value());
  });
  EXPECT_LT(median(errors.position_mm), 0.1);
  EXPECT_LT(median(errors.angle_deg), 0.01);
}

// The estimator's refined corners are free of the inward bias of OpenCV's (0.2 px here), which the
// adjustment has turned into a board 0.5 % too large for its tags (pitch 40.19 instead of 40 mm).
// Tags and their places therefore disagree by up to 0.4 mm at the rim: the poses may differ by
// about half of that.
TEST_P(PhotographsOf, EstimatorStaysCloseToTheAdjustment) {
  SKIP_WITHOUT(kData / GetParam());
  const Session session = open_session(kData / GetParam());
  const Trajectory truth = read_trajectory(session.poses.value());
  const auto estimator =
      make_tag_pose_estimator(read_board(session.board.value()), session.camera, {});
  Errors errors;
  for_each_frame(session, [&](const Frame& frame) {
    const auto result = estimator->estimate(frame);
    ASSERT_TRUE(std::holds_alternative<FramePose>(result)) << "frame " << frame.index;
    errors.add(std::get<FramePose>(result).camera_from_board,
               truth.board_from_camera(frame, 30).value());
  });
  EXPECT_LT(median(errors.position_mm), 0.3);
  EXPECT_LT(median(errors.angle_deg), 0.03);
}
/// The board as it was meant to be: tags of 35 mm flat on a grid of 40 mm.
Board nominal(const Board& surveyed) {
  Board flat = surveyed;
  for (auto& [id, tag] : flat.tags) {
    const Eigen::Vector3d place = tag.board_from_tag.translation();
    tag.board_from_tag = Eigen::Isometry3d::Identity();
    tag.board_from_tag.translation() << 0.04 * std::round(place.x() / 0.0402),
        0.04 * std::round(place.y() / 0.0402), 0;
  }
  return flat;
}

// Curled paper: heights differ by 0.6 to 0.7 mm, seen from half a metre at 1120 px of focal length
// and 60 degrees that is 0.7 px from end to end beside the 0.3 px of the corners themselves.
TEST_P(PhotographsOf, SurveyFindsTheCurlOfThePaper) {
  SKIP_WITHOUT(kData / GetParam());
  const Session session = open_session(kData / GetParam());
  const Board flat = nominal(read_board(session.board.value()));
  BoardTagFinder finder(flat, session.camera);
  std::vector<std::vector<TagDetection>> views;
  for_each_frame(session, [&](const Frame& frame) {
    finder.look_at(frame);
    views.push_back(finder.find());
  });
  const auto refinement = refine_board(flat, session.camera, views);
  ASSERT_TRUE(refinement);
  EXPECT_GT(refinement->rms_before_px, 0.45);
  EXPECT_LT(refinement->rms_after_px, 0.35);
}
INSTANTIATE_TEST_SUITE_P(Boards, PhotographsOf, testing::Values("box", "stone"));

// The frames that the recording's README calls good, and those with a visible smear.
TEST(HandheldVideo, PosesTheGoodFramesAndRefusesTheSmearedOnes) {
  const auto folder = kData / "visp_dragon";
  SKIP_WITHOUT(folder);
  const std::set<int> good{0,  1,  2,  3,  4,  5,  6,  7,  8,  14, 27, 28, 29,
                           31, 32, 33, 35, 63, 64, 74, 76, 77, 93, 96, 98};
  const std::set<int> smeared{50, 51, 55, 56, 82, 83};
  const Session session = open_session(folder);
  const auto estimator =
      make_tag_pose_estimator(read_board(session.board.value()), session.camera, {});
  const auto source = open_frames(session);
  std::vector<double> reprojection_px;
  while (const auto frame = source->next()) {
    if (!good.contains(frame->index) && !smeared.contains(frame->index)) continue;
    const auto result = estimator->estimate(*frame);
    if (smeared.contains(frame->index)) {
      ASSERT_TRUE(std::holds_alternative<PoseRejection>(result)) << "frame " << frame->index;
      EXPECT_EQ(name_of(std::get<PoseRejection>(result)), "blur");
    } else if (const auto* pose = std::get_if<FramePose>(&result)) {
      reprojection_px.push_back(pose->reprojection_px);
    }
  }
  EXPECT_GE(static_cast<double>(reprojection_px.size()), 0.9 * static_cast<double>(good.size()));
  EXPECT_LT(median(reprojection_px), 0.7);
}

// The reference is a joint pose over the tags that libapriltag decodes, repeatable to about 0.3 to
// 0.5 mm in slow frames; with unrefined corners it moves by 1 mm at a distance of 1.07 m. It is no
// measure of the tracker, which follows up to four tags more: the board is not flat (edges lie up
// to 1 px off, the same in every frame), so that poses over other tags differ by 4 mm and 0.2
// degrees.
TEST(HandheldVideo, DetectedPosesAgreeWithTheReference) {
  const auto folder = kData / "visp_dragon";
  SKIP_WITHOUT(folder);
  const Session session = open_session(folder);
  const Board board = read_board(session.board.value());
  const Trajectory reference = read_trajectory(folder / "poses-reference.txt");
  BoardTagFinder finder(board, session.camera);
  const auto source = open_frames(session, 0, 9);
  Errors errors;
  while (const auto frame = source->next()) {
    finder.look_at(*frame);
    const auto pose = estimate_joint_pose(board, session.camera, finder.find());
    ASSERT_TRUE(pose) << "frame " << frame->index;
    errors.add(pose->camera_from_board, reference.board_from_camera(*frame, 30).value());
  }
  EXPECT_LT(median(errors.position_mm), 2.5);
  EXPECT_LT(median(errors.angle_deg), 0.15);
}

/// The dragon's images while the camera hardly moves: its shutter rolls, and half a metre in
/// front of the board a moving camera puts it up to 38 px off. With the poses that the reference
/// place of the dragon was found with.
std::vector<RegistrationView> slow_views(const Session& session) {
  const Trajectory reference = read_trajectory(session.folder / "poses-reference.txt");
  const auto source = open_frames(session, 0, 8);
  std::vector<RegistrationView> views;
  while (const auto frame = source->next()) {
    const auto board_from_camera = reference.board_from_camera(*frame, 30);
    views.push_back({frame->image.clone(), board_from_camera.value().inverse(), 1});
  }
  return views;
}

// All views come from one side, so the distance is hardly told: what must agree between two starts
// 10 mm and 5 degrees apart is where the outline lies, not where the dragon stands. Its own masks
// put the reference (IoU .89) within a few pixels.
TEST(HandheldVideo, RegistersTheDragonFromTwoStarts) {
  const auto folder = kData / "visp_dragon";
  SKIP_WITHOUT(folder);
  const Session session = open_session(folder);
  const core::Mesh mesh = core::read_mesh(session.mesh);
  const auto views = slow_views(session);
  const Eigen::Isometry3d& reference = session.board_from_object;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& p : mesh.positions) centre += p.cast<double>();
  centre = reference * (centre / static_cast<double>(mesh.positions.size()));
  const Eigen::Isometry3d off =
      Eigen::Translation3d(centre + Eigen::Vector3d(0.006, 0.008, 0)) *
      Eigen::AngleAxisd(5 * std::numbers::pi / 180, Eigen::Vector3d(1, 1, 1).normalized()) *
      Eigen::Translation3d(-centre) * reference;
  const auto from_reference = register_object(mesh, session.camera, views, reference, {});
  const auto from_afar = register_object(mesh, session.camera, views, off, {});
  ASSERT_TRUE(from_reference && from_afar);
  EXPECT_LT(from_reference->motion_px, 3);
  EXPECT_GT(from_afar->motion_px, 5);
  double apart_px = 0;
  for (const auto& p : mesh.positions) {
    const auto a = session.camera.project(views[0].camera_from_board *
                                          from_reference->board_from_object * p.cast<double>());
    const auto b = session.camera.project(views[0].camera_from_board *
                                          from_afar->board_from_object * p.cast<double>());
    apart_px += (*a - *b).norm() / static_cast<double>(mesh.positions.size());
  }
  EXPECT_LT(apart_px, 0.5);
  for (const auto& found : {*from_reference, *from_afar}) {
    EXPECT_LT(found.residual_px, 0.6);
    EXPECT_GT(found.matched_share, 0.9);
  }
}

struct ExpectedTag {
  std::array<Eigen::Vector2d, 4> corners_px;
};

std::vector<ExpectedTag> read_expected(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<ExpectedTag> tags;
  for (std::string line; std::getline(in, line);) {
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    std::istringstream numbers(line);
    int id = 0;
    ExpectedTag tag;
    numbers >> id;
    for (Eigen::Vector2d& corner : tag.corners_px) {
      numbers >> corner.x() >> corner.y();
      corner -= Eigen::Vector2d(0.5, 0.5);  // libapriltag's pixels start at their corner
    }
    if (numbers) tags.push_back(tag);
  }
  return tags;
}

/// Largest distance of corresponding corners; the expected lists start at any corner.
double distance(const ExpectedTag& expected, const TagDetection& found, Eigen::Vector2d& shift) {
  double best = 1e9;
  for (std::size_t turn = 0; turn < 4; ++turn) {
    double worst = 0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector2d error = found.corners_px[c] - expected.corners_px[(c + turn) % 4];
      worst = std::max(worst, error.norm());
      sum += error;
    }
    if (worst < best) {
      best = worst;
      shift = sum / 4;
    }
  }
  return best;
}

// 45 of 47 are what libapriltag finds without decimation; one more may be lost to another version.
TEST(AprilTagPhotographs, FindTheLibrarysOwnCornersHalfAPixelOff) {
  const auto folder = kData / "apriltag_photos";
  SKIP_WITHOUT(folder);
  const TagDetector detector(find_tag_family("tag36h11", 1).value());
  int expected_count = 0;
  std::vector<double> shift_x;
  std::vector<double> shift_y;
  for (const char* name :
       {"33369213973_9d9bb4cc96_c", "34085369442_304b6bafd9_c", "34139872896_defdb2f8d9_c"}) {
    const cv::Mat grey = cv::imread((folder / name).string() + ".jpg", cv::IMREAD_GRAYSCALE);
    const auto found = detector.detect(grey);
    for (const ExpectedTag& expected : read_expected((folder / name).string() + ".txt")) {
      ++expected_count;
      Eigen::Vector2d shift = Eigen::Vector2d::Zero();
      const bool is_found = std::any_of(found.begin(), found.end(), [&](const TagDetection& tag) {
        return distance(expected, tag, shift) < 2;
      });
      if (!is_found) continue;
      shift_x.push_back(shift.x());
      shift_y.push_back(shift.y());
    }
  }
  EXPECT_EQ(expected_count, 12 + 25 + 10);
  ASSERT_GE(shift_x.size(), 44U);
  EXPECT_NEAR(median(shift_x), 0, 0.15);
  EXPECT_NEAR(median(shift_y), 0, 0.15);
}

}  // namespace
}  // namespace sheen::capture::test
