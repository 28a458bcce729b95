// SPDX-License-Identifier: MIT
// Camera -> recording -> model, with a camera that plays the sample recording.
#include "app/commands/capture.h"

#include "app/interrupt.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "tests/app/playing_camera.h"

#include <gtest/gtest.h>

#include <csignal>
#include <utility>

namespace sheen::tests {
namespace {

constexpr int kFrames = 16;

class LiveCapture : public testing::Test {
 protected:
  LiveCapture() {
    options_.session = folder_.path() / "walk";
    options_.like = sample_session();
    options_.frames = kFrames;
    context_.threads = 2;
    context_.quiet = true;
    context_.json = true;
    context_.report_path = folder_.path() / "report.json";
  }

  [[nodiscard]] nlohmann::json report() const {
    return nlohmann::json::parse(read_file(context_.report_path));
  }

  /// The model that a replay makes of the recording, from the command line. How large texels are
  /// is measured on poses, of which a capture has none when it begins.
  std::string replay() const {
    const auto model = folder_.path() / "replay.glb";
    const ProgramRun run = run_sheen({"replay", options_.session, "-o", model, "--texel-mm",
                                      report()["options"]["texel-mm"].dump(), "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    return read_file(model);
  }

  [[nodiscard]] std::string model() const { return read_file(options_.session / "model.glb"); }

  TemporaryFolder folder_;
  app::CaptureOptions options_;
  app::CommandContext context_;
};

TEST_F(LiveCapture, GivesTheModelThatAReplayOfItsRecordingGives) {
  app::capture_session(std::make_unique<PlayingCamera>(), options_, context_);
  const auto live = report();
  EXPECT_EQ(live["frames"]["read"], kFrames);
  EXPECT_GT(live["frames"]["fitted"], kFrames / 2);
  EXPECT_EQ(live["recording"]["recorded"], kFrames);
  EXPECT_EQ(live["recording"]["dropped"], 0);
  EXPECT_TRUE(live["recording"]["complete"]);
  EXPECT_TRUE(model() == replay());
}

TEST_F(LiveCapture, KeepsRecordingAndModelWhenTheCameraIsGone) {
  constexpr int delivered = 10;
  try {
    app::capture_session(std::make_unique<PlayingCamera>(delivered), options_, context_);
    FAIL() << "nothing was thrown";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/played: was unplugged"), std::string::npos);
    EXPECT_EQ(error.kind(), core::Error::Kind::run_failed);
  }
  EXPECT_EQ(report()["recording"]["recorded"], delivered);
  EXPECT_FALSE(report()["recording"]["complete"]);
  EXPECT_TRUE(model() == replay());
}

/// A camera that nobody has calibrated: its lens is found when the recording has ended, as a replay
/// finds it in the recording alone.
TEST_F(LiveCapture, WithoutACameraFileGivesTheModelThatAReplayGives) {
  const capture::Session like = capture::open_session(sample_session());
  options_.like.clear();
  options_.board = *like.board;
  options_.mesh = like.mesh;
  for (Eigen::Index i = 0; i < 16; ++i) {
    options_.board_from_object.push_back(like.board_from_object.matrix()(i / 4, i % 4));
  }
  app::capture_session(std::make_unique<PlayingCamera>(), options_, context_);
  EXPECT_EQ(report()["recording"]["recorded"], kFrames);
  EXPECT_TRUE(report()["walk"].contains("camera"));

  const auto session_file = options_.session / "session.json";
  auto as_recorded = nlohmann::json::parse(read_file(session_file));
  as_recorded.erase("camera");
  write_file(session_file, as_recorded.dump());
  std::filesystem::remove(options_.session / "camera.yaml");
  const auto model = folder_.path() / "replay.glb";
  const ProgramRun run = run_sheen({"replay", options_.session, "-o", model, "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_TRUE(this->model() == read_file(model));
}

TEST_F(LiveCapture, RefusesAnotherBoardThanTheDefaultSheet) {
  options_.like.clear();
  try {
    app::capture_session(std::make_unique<PlayingCamera>(), options_, context_);
    FAIL() << "the sample's tags are none of the default sheet's";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("its first image shows another board"),
              std::string::npos)
        << error.what();
  }
}

/// Says of itself that its raw images are of odd width.
class OddCamera : public PlayingCamera {
 public:
  [[nodiscard]] capture::CameraDescription description() const override {
    auto odd = PlayingCamera::description();
    odd.format = capture::PixelFormat::yuyv;
    odd.width_px = 641;
    return odd;
  }
};

TEST_F(LiveCapture, RefusesRawImagesThatCannotBePackedBeforeTheFolderIsMade) {
  try {
    app::capture_session(std::make_unique<OddCamera>(), options_, context_);
    FAIL() << "nothing was thrown";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("odd size, 641x360"), std::string::npos)
        << error.what();
    EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
  }
  EXPECT_FALSE(std::filesystem::exists(options_.session));
}

/// Somebody presses Ctrl-C when image 10 is due.
class InterruptedCamera : public PlayingCamera {
 public:
  std::optional<capture::CameraBuffer> next(std::chrono::milliseconds timeout) override {
    if (++asked_ == 10) std::raise(SIGINT);
    return PlayingCamera::next(timeout);
  }

 private:
  int asked_ = 0;
};

TEST_F(LiveCapture, FinishesWhenItIsInterrupted) {
  app::watch_for_interrupts();
  options_.frames.reset();
  app::capture_session(std::make_unique<InterruptedCamera>(), options_, context_);
  EXPECT_EQ(report()["recording"]["recorded"], 10);
  EXPECT_TRUE(report()["recording"]["complete"]);
  EXPECT_TRUE(model() == replay());
  EXPECT_NO_THROW(app::throw_if_interrupted());  // the wish was obeyed
}

TEST_F(LiveCapture, EndsAfterTheTimeThatWasAskedFor) {
  options_.frames.reset();
  options_.seconds = 0.5;
  app::capture_session(std::make_unique<PlayingCamera>(), options_, context_);
  // The last is the first 15/30 s after image 7, which is 22; of these 16 the camera loses 9 and
  // 19.
  EXPECT_EQ(report()["recording"]["recorded"], 14);
}

TEST_F(LiveCapture, RefusesWhatDoesNotFitTogether) {
  const auto expect_refused = [&](const std::string& word) {
    try {
      app::capture_session(std::make_unique<PlayingCamera>(), options_, context_);
      ADD_FAILURE() << "nothing was thrown for " << word;
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  options_.board_from_object = std::vector<double>(16, 0.5);
  expect_refused("--T-stage-object");
  options_.like.clear();
  expect_refused("--T-stage-object: places a mesh, and there is none");
  options_.like = sample_session();
  options_.board_from_object.clear();
  options_.mesh = sample_session() / "camera.yaml";
  expect_refused("camera.yaml");
  options_.mesh.clear();
  options_.board = sample_session() / "object.ply";
  expect_refused("object.ply");
  options_.board.clear();
  options_.fit.output = sample_session() / "board.yaml" / "model.glb";
  expect_refused("board.yaml");
  options_.fit.output.clear();
  EXPECT_FALSE(std::filesystem::exists(options_.session));  // nothing stands in the next one's way
  std::filesystem::create_directories(options_.session);
  write_file(options_.session / "notes.txt", "mine");
  expect_refused("exists already");
  EXPECT_EQ(read_file(options_.session / "notes.txt"), "mine");
}

TEST(CommandContext, SaysNothingTwice) {
  app::CommandContext context;
  context.quiet = true;
  context.note("note: colours are taken for sRGB");
  context.note("note: 2 damaged frames were left out");
  context.note("note: colours are taken for sRGB");
  EXPECT_EQ(context.notes->lines.size(), 2U);
}

TEST(CaptureCommand, SaysWhichDeviceIsMissing) {
  const TemporaryFolder folder;
  const ProgramRun run = run_sheen({"capture", "/dev/no-such-camera", "-o", folder.path() / "s",
                                    "--like", sample_session(), "--headless"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.standard_error.find("/dev/no-such-camera"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "s"));
  EXPECT_EQ(run_sheen({"capture", "--list", "--json"}).exit_code, 0);
}

}  // namespace
}  // namespace sheen::tests
