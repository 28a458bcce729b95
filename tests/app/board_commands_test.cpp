// SPDX-License-Identifier: MIT
// `sheen calibrate`, `survey` and `register` on the sample session, whose truth is known.
#include "capture/calibration/camera_file.h"
#include "capture/pose/board.h"
#include "capture/session/keep_before.h"
#include "capture/session/session.h"
#include "capture/session/session_file.h"
#include "tests/app/program.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

namespace sheen::tests {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A copy of the sample session that a test may change.
class BoardCommands : public testing::Test {
 protected:
  BoardCommands() : session_(folder_.path() / "session") {
    std::filesystem::create_directories(session_);
    for (const char* name :
         {"session.json", "camera.yaml", "board.yaml", "object.ply", "frames.avi"}) {
      std::filesystem::copy_file(sample_session() / name, session_ / name);
    }
  }

  void expect_refused(const ProgramRun& run, const std::string& word) const {
    EXPECT_EQ(run.exit_code, 2) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1)
        << run.standard_error;
    EXPECT_NE(run.standard_error.find(word), std::string::npos) << run.standard_error;
  }

  TemporaryFolder folder_;
  std::filesystem::path session_;
};

TEST_F(BoardCommands, CalibrateFindsTheSampleCamera) {
  const auto camera = folder_.path() / "camera.yaml";
  const auto image = folder_.path() / "coverage.png";
  const ProgramRun run = run_sheen({"calibrate", session_, "--board", session_ / "board.yaml", "-o",
                                    camera, "--picture", image, "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto found = capture::read_camera(camera).intrinsics();
  const auto truth = capture::read_camera(session_ / "camera.yaml").intrinsics();
  // What the report says of its own errors, four standard deviations, and half a pixel for what
  // the JPEG and the blur of a moving camera do to all corners alike.
  const auto report = run.json();
  for (int i = 0; i < 2; ++i) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_NEAR(found.focal_px[i], truth.focal_px[i],
                0.5 + 4 * report["focal_sigma_px"][index].get<double>());
    EXPECT_NEAR(found.principal_px[i], truth.principal_px[i],
                0.5 + 4 * report["principal_sigma_px"][index].get<double>());
  }
  EXPECT_LT(report["rms_px"].get<double>(), 0.2);
  EXPECT_TRUE(std::filesystem::is_regular_file(image));
}

TEST_F(BoardCommands, CalibrateRefusesImagesOfSomethingElse) {
  const auto camera = folder_.path() / "camera.yaml";
  write_file(camera, "an earlier camera");
  const auto other = folder_.path() / "other.pdf";
  ASSERT_EQ(run_sheen({"board", "-o", other, "--family", "tag25h9"}).exit_code, 0);
  expect_refused(run_sheen({"calibrate", session_, "--board", folder_.path() / "other.yaml", "-o",
                            camera, "--quiet"}),
                 "show the target");
  EXPECT_EQ(read_file(camera), "an earlier camera");
  expect_refused(run_sheen({"calibrate", session_, "-o", camera}), "board");
}

TEST_F(BoardCommands, SurveyFindsDisplacedTagsAndKeepsTheOldBoard) {
  capture::Board board = capture::read_board(session_ / "board.yaml");
  std::mt19937 random(9);
  std::normal_distribution<double> shift_m(0, 0.0005);
  for (auto& [id, tag] : board.tags) {
    tag.board_from_tag.translation() +=
        Eigen::Vector3d(shift_m(random), shift_m(random), shift_m(random));
  }
  capture::write_board(session_ / "board.yaml", board);
  const std::string before = read_file(session_ / "board.yaml");

  const ProgramRun run = run_sheen({"survey", session_, "-o", session_ / "board.yaml", "--picture",
                                    folder_.path() / "board.png", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto report = run.json();
  // The sample's own tags fit to 0.25 px; half a millimetre at half a metre and 576 px is 0.6 px.
  EXPECT_GT(report["rms_before_px"].get<double>(), 0.6);
  EXPECT_LT(report["rms_after_px"].get<double>(), 0.3);
  EXPECT_EQ(report["changes"].size(), board.tags.size());
  EXPECT_EQ(read_file(session_ / "board.before-survey.yaml"), before);
  EXPECT_NE(read_file(session_ / "board.yaml"), before);
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_.path() / "board.png"));
}

TEST_F(BoardCommands, SurveyLeavesTheSessionAloneByDefault) {
  const std::string before = read_file(session_ / "board.yaml");
  const ProgramRun run = run_sheen({"survey", session_, "--quiet", "--end", "40"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(read_file(session_ / "board.yaml"), before);
  EXPECT_EQ(capture::read_board(session_ / "board.surveyed.yaml").tags.size(),
            capture::read_board(session_ / "board.yaml").tags.size());
}

TEST_F(BoardCommands, RegisterFindsTheObjectAndKeepsTheOldPlace) {
  // 10 mm and 5 degrees off; the goal is 1 mm and 0.5 degrees.
  const Eigen::Isometry3d truth = capture::open_session(session_).board_from_object;
  const Eigen::Isometry3d start =
      Eigen::Translation3d(0.006, -0.007, 0.004) *
      Eigen::AngleAxisd(5 * kDegree, Eigen::Vector3d(1, -1, 2).normalized()) * truth;
  capture::write_board_from_object(session_ / "session.json", session_ / "session.json", start);
  const std::string before = read_file(session_ / "session.json");

  const ProgramRun run = run_sheen({"register", session_, "--views", "12", "--picture",
                                    folder_.path() / "outline.png", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const Eigen::Isometry3d found = capture::open_session(session_).board_from_object;
  EXPECT_LT((found.translation() - truth.translation()).norm(), 1e-3);
  EXPECT_LT(Eigen::AngleAxisd(found.linear() * truth.linear().transpose()).angle(), 0.5 * kDegree);
  EXPECT_LT(run.json()["residual_px"].get<double>(), 0.5);
  EXPECT_EQ(read_file(session_ / "session.before-register.json"), before);
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_.path() / "outline.png"));
}

TEST_F(BoardCommands, WhatWasKeptFirstStays) {
  const auto board = session_ / "board.yaml";
  const std::string first = read_file(board);
  EXPECT_EQ(capture::keep_before(board, "survey"), session_ / "board.before-survey.yaml");
  write_file(board, "second");
  EXPECT_EQ(capture::keep_before(board, "survey"), session_ / "board.before-survey-2.yaml");
  write_file(board, "third");
  EXPECT_EQ(capture::keep_before(board, "survey"), session_ / "board.before-survey-3.yaml");
  EXPECT_EQ(read_file(session_ / "board.before-survey.yaml"), first);
  EXPECT_EQ(read_file(session_ / "board.before-survey-2.yaml"), "second");
}

TEST_F(BoardCommands, RegisterRefusesAHopelessStart) {
  const Eigen::Isometry3d truth = capture::open_session(session_).board_from_object;
  capture::write_board_from_object(session_ / "session.json", session_ / "session.json",
                                   Eigen::Translation3d(0, 0, 3) * truth);
  const std::string before = read_file(session_ / "session.json");
  expect_refused(run_sheen({"register", session_, "--views", "6", "--end", "30", "--quiet"}),
                 "outline");
  EXPECT_EQ(read_file(session_ / "session.json"), before);
}

}  // namespace
}  // namespace sheen::tests
