// SPDX-License-Identifier: MIT
// A camera that nobody has calibrated, an object that nobody has measured: one recording.
#include "app/commands/capture.h"
#include "capture/synthetic/synthetic_session.h"
#include "tests/app/playing_camera.h"

#include <gtest/gtest.h>

namespace sheen::tests {
namespace {

constexpr int kFrames = 16;

TEST(WalkCapture, GivesTheModelThatAReplayOfItsRecordingGives) {
  const TemporaryFolder folder;
  capture::synthetic::SyntheticOptions scene;
  scene.scene = capture::synthetic::SceneKind::matte;
  scene.width_px = 320;
  scene.height_px = 240;
  scene.frames = kFrames;
  scene.held_out = 0;
  scene.samples = 1;
  scene.vertices = 500;
  const auto truth = folder.path() / "truth";
  capture::synthetic::write_synthetic_session(truth, scene, [](int, int) {});

  app::CaptureOptions options;
  options.session = folder.path() / "walk";
  options.board = truth / "board.yaml";
  options.frames = kFrames;
  options.fit.reconstruction.representation = "mean";
  app::CommandContext context;
  context.threads = 2;
  context.quiet = true;
  context.report_path = folder.path() / "report.json";
  app::capture_session(std::make_unique<PlayingCamera>(std::nullopt, truth), options, context);
  const auto report = nlohmann::json::parse(read_file(context.report_path));
  EXPECT_EQ(report["recording"]["recorded"], kFrames);
  EXPECT_TRUE(report["walk"].contains("camera"));
  EXPECT_GT(report["walk"]["mesh"]["covered_share"].get<double>(), 0.9);
  // Nothing was there to be kept.
  EXPECT_FALSE(std::filesystem::exists(options.session / "session.before-mesh.json"));

  // What was recorded and nothing else.
  const auto bare = folder.path() / "bare";
  std::filesystem::create_directories(bare);
  for (const char* name : {"frames.avi", "frames.csv", "board.yaml"}) {
    std::filesystem::copy_file(options.session / name, bare / name);
  }
  auto session = nlohmann::json::parse(read_file(options.session / "session.json"));
  session.erase("camera");
  session.erase("object");
  write_file(bare / "session.json", session.dump());
  const auto model = folder.path() / "replay.glb";
  const ProgramRun run =
      run_sheen({"replay", bare, "-o", model, "--representation", "mean", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_TRUE(read_file(options.session / "model.glb") == read_file(model));
}

}  // namespace
}  // namespace sheen::tests
