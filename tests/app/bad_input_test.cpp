// SPDX-License-Identifier: MIT
// Bad input gets one clear line and exit code 2, and nothing existing is overwritten.
#include "tests/app/copied_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;

/// A session that a test may spoil, and a model that must survive.
class BadInput : public CopiedSession {
 protected:
  BadInput() { write_file(model_, "an earlier model"); }

  void cut(const fs::path& path, double fraction) const {
    const auto size = static_cast<double>(fs::file_size(path));
    fs::resize_file(path, static_cast<std::uintmax_t>(size * fraction));
  }

  /// The replay is refused with one line that names `subject`.
  void expect_refused(const std::string& subject) const {
    const ProgramRun run = run_sheen({"replay", session_, "-o", model_, "--quiet"});
    expect_one_line(run, subject);
    EXPECT_EQ(read_file(model_), "an earlier model");
    // Nothing half-written is left beside the model either.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
  }

  static void expect_one_line(const ProgramRun& run, const std::string& subject) {
    EXPECT_EQ(run.exit_code, 2) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1)
        << run.standard_error;
    EXPECT_NE(run.standard_error.find(subject), std::string::npos) << run.standard_error;
    EXPECT_TRUE(run.standard_output.empty()) << run.standard_output;
  }
};

TEST_F(BadInput, MissingSession) {
  fs::remove_all(session_);
  const ProgramRun run = run_sheen({"replay", session_, "-o", model_, "--quiet"});
  expect_one_line(run, "session");
}

TEST_F(BadInput, EmptyFolder) {
  fs::remove_all(session_);
  fs::create_directories(session_);
  expect_refused("session.json");
}

TEST_F(BadInput, MissingVideo) {
  fs::remove(session_ / "frames.avi");
  expect_refused("frames.avi");
}

TEST_F(BadInput, TruncatedVideo) {
  cut(session_ / "frames.avi", 0.4);
  expect_refused("frames.avi");
}

TEST_F(BadInput, EmptyVideo) {
  write_file(session_ / "frames.avi", "");
  expect_refused("frames.avi");
}

TEST_F(BadInput, CameraOfAnotherImageSize) {
  replace("camera.yaml", "image_width: *[0-9]+", "image_width: 320");
  expect_refused("320x360");
}

// 640 x 360 images are twice as large in both directions.
TEST_F(BadInput, CameraOfScaledImagesIsToldTheFactor) {
  replace("camera.yaml", "image_width: *[0-9]+", "image_width: 320");
  replace("camera.yaml", "image_height: *[0-9]+", "image_height: 180");
  replace("camera.yaml", "576[.], 0[.], 3.2319999999999999e[+]02", "288., 0., 161.35");
  replace("camera.yaml", "5.7715200000000004e[+]02,\\s+1.7740000000000001e[+]02", "288.576, 88.45");
  expect_refused("scaled, multiply fx, fy, cx + 0.5 and cy + 0.5 in that file by 2");
}

TEST_F(BadInput, CameraThatIsNoYaml) {
  write_file(session_ / "camera.yaml", "\x01\x02 not yaml {{{");
  expect_refused("camera.yaml");
}

TEST_F(BadInput, UnknownTagFamily) {
  replace("board.yaml", "tag36h11", "tag99h9");
  expect_refused("board.yaml");
}

TEST_F(BadInput, DuplicateTagIds) {
  replace("board.yaml", "id: 1,", "id: 0,");
  expect_refused("board.yaml");
}

TEST_F(BadInput, MeshWithoutTriangles) {
  write_file(session_ / "object.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
  expect_refused("object.ply");
}

TEST_F(BadInput, MeshWithNaN) {
  write_file(
      session_ / "object.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
  expect_refused("object.ply");
}

TEST_F(BadInput, MeshInMillimetres) {
  write_file(
      session_ / "object.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n60000 0 0\n0 60000 0\n3 0 1 2\n");
  expect_refused("object.ply");
}

TEST_F(BadInput, SessionOfALaterVersion) {
  replace("session.json", "\"version\": *1", "\"version\": 2");
  expect_refused("session.json");
}

TEST_F(BadInput, PathThatLeavesTheFolder) {
  replace("session.json", "\"object.ply\"", "\"../object.ply\"");
  expect_refused("session.json");
}

TEST_F(BadInput, TransformThatScales) {
  replace("session.json", "(\"T_stage_object\": *\\[\\s*)[-0-9.e]+", "$017.5");
  expect_refused("session.json");
}

TEST_F(BadInput, ModelCutInHalf) {
  const auto model = folder_.path() / "cut.glb";
  const ProgramRun replay = run_sheen(
      {"replay", session_, "-o", model, "--end", "4", "--representation", "mean", "--quiet"});
  ASSERT_EQ(replay.exit_code, 0) << replay.standard_error;
  cut(model, 0.5);
  expect_one_line(run_sheen({"info", model, "--quiet"}), "cut.glb");
  expect_one_line(run_sheen({"evaluate", model, sample_session() / "held_out", "--quiet"}),
                  "cut.glb");
}

TEST_F(BadInput, OutputFolderThatCannotBeMade) {
  // A file stands where the folder of the model should be.
  const ProgramRun run =
      run_sheen({"replay", session_, "-o", model_ / "in" / "model.glb", "--end", "4", "--quiet"});
  expect_one_line(run, "model.glb");
}

TEST_F(BadInput, ReportThatCannotBeWrittenIsToldBeforeTheWork) {
  // The model file is none: a command that reads it first would name that one.
  const std::string report = session_ / "object.ply" / "report.json";
  const std::string model = model_;
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"evaluate", model, session_},
        {"render", model, "--views", session_, "-o", folder_.path() / "views"}}) {
    auto arguments = command;
    arguments.insert(arguments.end(), {"--report", report});
    expect_one_line(run_sheen(arguments), "report.json");
  }
}

TEST_F(BadInput, WrongArguments) {
  expect_one_line(run_sheen({"replay"}), "session");
  expect_one_line(run_sheen({"fly"}), "fly");
  expect_one_line(run_sheen({"replay", session_, "-o", model_, "--centers", "17"}), "--centers");
  expect_one_line(run_sheen({"replay", session_, "-o", model_, "--fitter", "best"}), "--fitter");
  expect_one_line(run_sheen({"replay", session_, "-o", model_, "--hold-out", "1"}), "2 or more");
  expect_one_line(run_sheen({"replay", session_, "-o", model_, "--hold-out", "-1"}), "--hold-out");
  expect_one_line(run_sheen({"replay", session_, "-o", model_, "--threads", "0"}), "--threads");
  expect_one_line(run_sheen({"synth", "chrome", "-o", folder_.path() / "s"}), "chrome");
}

TEST(Program, HelpAndVersionSucceedOnStandardOutput) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"--version"}, {"--help"}, {"replay", "--help"}, {"synth", "--help"}}) {
    const ProgramRun run = run_sheen(arguments);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.standard_output.find("heen"), std::string::npos) << run.standard_output;
    EXPECT_TRUE(run.standard_error.empty()) << run.standard_error;
  }
}

}  // namespace
}  // namespace sheen::tests
