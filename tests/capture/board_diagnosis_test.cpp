// SPDX-License-Identifier: MIT
#include "capture/pose/board_diagnosis.h"

#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace sheen::capture::test {
namespace {

const core::CameraModel kLens = make_camera(960, 720, true);

Board printed() {
  return make_grid_board("tag36h11", 5, 4, 0.04, 0.052);
}

/// Three images of the printed board, drawn once (under sanitizers an image takes seconds).
const std::vector<Frame>& images() {
  static const std::vector<Frame> frames = [] {
    std::vector<Frame> drawn(3);
    for (int i = 0; i < 3; ++i) {
      drawn[i].index = i;
      drawn[i].image = render_board(printed(), kLens, look_at_board(0.5, 0.8 + 0.1 * i, 0.7 * i),
                                    {.supersampling = 2});
    }
    return drawn;
  }();
  return frames;
}

/// The same, each changed by `spoil`.
std::vector<Frame> images_spoilt_by(const std::function<void(cv::Mat&)>& spoil) {
  std::vector<Frame> frames = images();
  for (Frame& frame : frames) {
    frame.image = frame.image.clone();
    spoil(frame.image);
  }
  return frames;
}

PoseCause cause_of(const Board& stated, const std::vector<Frame>& frames, PoseRejection refusal,
                   const core::CameraModel& lens = kLens) {
  BoardDiagnosis diagnosis(stated, lens);
  for (const Frame& frame : frames) diagnosis.look_at(frame);
  return diagnosis.cause(refusal);
}

void expect_cause(const PoseCause& cause, PoseSuspect suspect, const std::string& word) {
  EXPECT_EQ(cause.suspect, suspect) << cause.fault;
  EXPECT_NE((cause.fault + "; " + cause.remedy).find(word), std::string::npos) << cause.fault;
}

TEST(BoardDiagnosis, BlamesTheBoardForSizesTurnsAndMirroredPlaces) {
  const std::vector<Frame>& frames = images();
  Board board = printed();
  for (auto& [id, tag] : board.tags) tag.size_m = 0.03;
  expect_cause(cause_of(board, frames, PoseRejection::reprojection), PoseSuspect::board,
               "1.33 times");

  board = printed();
  for (auto& [id, tag] : board.tags) {
    tag.board_from_tag.rotate(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitZ()));
  }
  expect_cause(cause_of(board, frames, PoseRejection::reprojection), PoseSuspect::board,
               "turned by 90 degrees");

  // y counted downwards, as pictures do.
  board = printed();
  for (auto& [id, tag] : board.tags) tag.board_from_tag.translation().y() *= -1;
  expect_cause(cause_of(board, frames, PoseRejection::reprojection), PoseSuspect::board,
               "mirrored");
}

TEST(BoardDiagnosis, BlamesTheBoardForTagsThatItDoesNotHold) {
  const std::vector<Frame>& frames = images();
  Board board;
  board.family = "tag36h11";
  for (const auto& [id, tag] : printed().tags) board.tags[id + 100] = tag;
  expect_cause(cause_of(board, frames, PoseRejection::no_tags), PoseSuspect::board,
               "none of the tags");
  board = make_grid_board("tag25h9", 5, 4, 0.04, 0.052);
  expect_cause(cause_of(board, frames, PoseRejection::no_tags), PoseSuspect::board, "tag36h11");
}

// A board of 5 x 4 tags whose ids are two too high, or in another order.
TEST(BoardDiagnosis, BlamesTheBoardForIdsOfOtherTags) {
  Board board = printed();
  board.tags.clear();
  for (const auto& [id, tag] : printed().tags) board.tags[id + 2] = tag;
  expect_cause(cause_of(board, images(), PoseRejection::reprojection), PoseSuspect::board,
               "2 too high");
  board.tags.clear();
  for (const auto& [id, tag] : printed().tags) board.tags[7 * id % 20] = tag;
  expect_cause(cause_of(board, images(), PoseRejection::reprojection), PoseSuspect::board,
               "another order");
}

TEST(BoardDiagnosis, BlamesTheCameraFileForAnotherLens) {
  const std::vector<Frame>& frames = images();
  auto other = kLens.intrinsics();
  other.focal_px *= 1.4;  // of a larger image
  expect_cause(cause_of(printed(), frames, PoseRejection::reprojection, core::CameraModel(other)),
               PoseSuspect::camera, "focal length");
  // The four numbers of a fisheye read as k1 k2 p1 p2.
  other = kLens.intrinsics();
  other.distortion = {0.9, -0.6, 0.2, -0.15, 0, 0, 0, 0};
  expect_cause(cause_of(printed(), frames, PoseRejection::reprojection, core::CameraModel(other)),
               PoseSuspect::camera, "fisheye");
}

TEST(BoardDiagnosis, BlamesTheRecordingForWhatItShows) {
  const Board board = printed();
  expect_cause(cause_of(board, images_spoilt_by([](cv::Mat& image) { cv::flip(image, image, 1); }),
                        PoseRejection::no_tags),
               PoseSuspect::recording, "mirrored");
  expect_cause(
      cause_of(board, images_spoilt_by([](cv::Mat& image) { cv::bitwise_not(image, image); }),
               PoseRejection::no_tags),
      PoseSuspect::recording, "white on black");
  expect_cause(cause_of(board, images(), PoseRejection::blur), PoseSuspect::recording, "smeared");
  const PoseCause dark =
      cause_of(board, images_spoilt_by([](cv::Mat& image) { image = cv::Scalar::all(10); }),
               PoseRejection::no_tags);
  expect_cause(dark, PoseSuspect::recording, "no tag");
  EXPECT_FALSE(dark.is_sure);
}

}  // namespace
}  // namespace sheen::capture::test
