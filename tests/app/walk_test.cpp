// SPDX-License-Identifier: MIT
// Recordings that lack camera, board or both; the sample session's truth is known.
#include "capture/calibration/camera_file.h"
#include "tests/app/copied_session.h"

#include <algorithm>
#include <cstdlib>

namespace sheen::tests {
namespace {

class Walk : public CopiedSession {
 protected:
  void forget(const std::string& what) const {
    replace("session.json", "\"" + what + "\": \"" + what + ".yaml\",\\s*", "");
    std::filesystem::rename(session_ / (what + ".yaml"), folder_.path() / (what + ".yaml"));
  }
};

TEST_F(Walk, WithoutACameraFindsIt) {
  forget("camera");
  const ProgramRun run = run_sheen({"replay", session_, "-o", model_, "--end", "40",
                                    "--representation", "mean", "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto found = capture::read_camera(session_ / "camera.yaml").intrinsics();
  const auto truth = capture::read_camera(folder_.path() / "camera.yaml").intrinsics();
  // What the report says of its own errors, four standard deviations, and what blur and JPEG do to
  // all corners alike, half a pixel.
  const auto numbers = run.json()["walk"]["camera"]["numbers"];
  EXPECT_NEAR(found.focal_px.x(), truth.focal_px.x(), 0.5 + 4 * numbers[0]["sigma"].get<double>());
  EXPECT_LT(run.json()["walk"]["camera"]["height_sigma"].get<double>(), 0.02);
  // The session is complete from now on: the same camera again, and nothing to find.
  const ProgramRun again = run_sheen({"replay", session_, "-o", model_, "--end", "4",
                                      "--representation", "mean", "--json", "--quiet"});
  ASSERT_EQ(again.exit_code, 0) << again.standard_error;
  EXPECT_FALSE(again.json().contains("walk"));
}

TEST_F(Walk, SaysThatAnotherBoardNeedsItsFile) {
  // The sample's board has the ids 0 to 39, none of the default sheet's.
  forget("board");
  const ProgramRun run = run_sheen({"replay", session_, "-o", model_, "--quiet"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1);
  EXPECT_NE(run.standard_error.find(
                "its first image shows another board than the sheet of sheen board, which holds "
                "none of the tags in the images (ids 0, ...); give the file of that board: "
                "--board board.yaml"),
            std::string::npos)
      << run.standard_error;
  EXPECT_FALSE(std::filesystem::exists(session_ / "board.yaml"));
  const ProgramRun given =
      run_sheen({"replay", session_, "-o", model_, "--board", folder_.path() / "board.yaml",
                 "--end", "4", "--representation", "mean", "--quiet"});
  EXPECT_EQ(given.exit_code, 0) << given.standard_error;
}

TEST_F(Walk, AVideoThatCannotBeCompletedLeavesNothing) {
  const auto video = folder_.path() / "walk.avi";
  std::filesystem::copy_file(session_ / "frames.avi", video);
  const ProgramRun run = run_sheen({"replay", video, "-o", model_, "--quiet"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.standard_error.find("another board"), std::string::npos) << run.standard_error;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "model"));
  EXPECT_TRUE(std::filesystem::exists(video));
}

TEST_F(Walk, WhatCannotBeReadIsNamedAsItWasGiven) {
  const auto pictures = folder_.path() / "pictures";
  std::filesystem::create_directory(pictures);
  const auto expect_refused = [&](const std::filesystem::path& source, const std::string& line) {
    const ProgramRun run = run_sheen({"replay", source, "-o", model_, "--quiet"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.standard_error, "sheen: " + line + "\n");
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "model"));
  };
  const std::string one = pictures / "one.jpg";
  write_file(one, "");
  expect_refused(one, one + ": is one picture; name the folder with all pictures, or a video");
  expect_refused(pictures, one + ": is empty; check that it is complete, or leave it out");
  const std::string video = folder_.path() / "empty.mp4";
  write_file(video, "");
  expect_refused(video, video + ": is empty; copy or record it again");
}

TEST_F(Walk, TooFewFramesDoNotTellTheCamera) {
  forget("camera");
  const ProgramRun run = run_sheen({"replay", session_, "-o", model_, "--end", "3", "--quiet"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.standard_error.find("3 of its 3 images show two tags of the board or more, 6 are "
                                    "needed to find the camera"),
            std::string::npos)
      << run.standard_error;
}

TEST(Sheen, WithoutArgumentsAndDisplayNamesThreeCommands) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const ProgramRun run = run_sheen({});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* command : {"sheen board", "sheen replay walk.mp4", "sheen view"}) {
    EXPECT_NE(run.standard_output.find(command), std::string::npos) << run.standard_output;
  }
}

}  // namespace
}  // namespace sheen::tests
