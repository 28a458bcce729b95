// SPDX-License-Identifier: MIT
#include "app/preview/preview_window.h"
#include "app/preview/walk_window.h"
#include "app/start/start_window.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "tests/app/display.h"
#include "tests/app/playing_camera.h"
#include "tests/app/program.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cstdlib>

namespace sheen::app {
namespace {

constexpr int kPatience = 200;  // redraws until an event must have arrived

class ViewerWindow : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { display_ = tests::VirtualDisplay::open(1400, 900).release(); }
  static void TearDownTestSuite() {
    delete display_;
    display_ = nullptr;
  }
  void SetUp() override {
    if (display_ == nullptr) GTEST_SKIP() << "Xvfb or xdotool is not installed: no window to test";
    window_.emplace(PreviewSubject{.title = "test",
                                   .mesh = mesh_,
                                   .up = Eigen::Vector3d::UnitZ(),
                                   .light_field = &light_field_,
                                   .facts = {{"patches", "many"}},
                                   .snapshot_folder = folder_.path()});
    for (int i = 0; i < 3; ++i) window_->redraw(0);
    display_->act({"mousemove", "500", "300"});  // a window without manager has its pointer's keys
    window_->redraw(0.05);
  }

  // Redraws until something is so; false when it never is.
  template <typename Condition>
  bool soon(const Condition& condition) {
    for (int i = 0; i < kPatience; ++i) {
      if (condition()) return true;
      if (!window_->redraw(0.02)) return condition();
    }
    return condition();
  }
  void press(const std::string& key) { display_->act({"key", "--clearmodifiers", key}); }

  // What the window shows, by its own snapshot.
  cv::Mat image() {
    window_->obey(ViewCommand::snapshot);
    window_->redraw(0);
    return window_->image().clone();
  }
  // Share of the pixels of the view's middle that are not background.
  double filled() {
    const cv::Mat all = image();
    const cv::Mat middle =
        all(cv::Rect(all.cols / 4, all.rows / 4, all.cols / 4, all.rows / 2)).clone();
    cv::Mat bright;
    cv::reduce(middle.reshape(1, static_cast<int>(middle.total())), bright, 1, cv::REDUCE_MAX);
    return cv::countNonZero(bright > 40) / static_cast<double>(middle.total());
  }

  static inline tests::VirtualDisplay* display_ = nullptr;
  tests::TemporaryFolder folder_;
  core::Mesh mesh_ = render::testing::torus_knot(0.1f, 120, 24);
  fitting::mean::MeanLightField light_field_ =
      render::testing::random_mean(mesh_.positions.size(), 0);
  std::optional<PreviewWindow> window_;
};

TEST_F(ViewerWindow, ShowsTheObjectAndKeepsASnapshot) {
  // The knot's silhouette fills a good part of the middle; an empty view would be all background.
  EXPECT_GT(filled(), 0.25);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "sheen-001.png"));
}

TEST_F(ViewerWindow, LeftDragTurnsWheelComesNearerFFramesAgain) {
  const auto eye = [&]() -> Eigen::Vector3d {
    return window_->camera().camera_from_object().inverse().translation();
  };
  const Eigen::Vector3d start = eye();
  // A hand takes its time: the button is down for at least a redraw before the mouse moves.
  display_->act({"mousedown", "1"});
  for (int i = 0; i < 3; ++i) window_->redraw(0.02);
  display_->act({"mousemove_relative", "100", "0"});
  EXPECT_TRUE(soon([&] { return (eye() - start).norm() > 0.1 * start.norm(); }));
  display_->act({"mouseup", "1"});
  for (int i = 0; i < 3; ++i) window_->redraw(0.02);
  EXPECT_NEAR(eye().norm(), start.norm(), 0.02 * start.norm());

  display_->act({"click", "4"});
  EXPECT_TRUE(soon([&] { return eye().norm() < 0.9 * start.norm(); }));
  press("f");
  EXPECT_TRUE(soon([&] { return std::abs(eye().norm() - start.norm()) < 0.02 * start.norm(); }));
}

TEST_F(ViewerWindow, NumberKeysChooseLayersThatExist) {
  press("4");
  EXPECT_TRUE(soon([&] { return window_->state().layer == Layer::mesh; }));
  // A finished model has no scores. Keys are handled in the order in which they are pressed: once
  // the help is there, so was the other one.
  press("2");
  press("h");
  EXPECT_TRUE(soon([&] { return window_->state().help; }));
  EXPECT_EQ(window_->state().layer, Layer::mesh);
  press("h");
  press("1");
  EXPECT_TRUE(soon([&] { return window_->state().layer == Layer::radiance; }));
}

TEST_F(ViewerWindow, HelpComesAndGoes) {
  press("h");
  EXPECT_TRUE(soon([&] { return window_->state().help; }));
  press("h");
  EXPECT_TRUE(soon([&] { return !window_->state().help; }));
}

TEST_F(ViewerWindow, ClosesOnRequest) {
  press("q");
  bool open = true;
  for (int i = 0; open && i < kPatience; ++i) open = window_->redraw(0.02);
  EXPECT_FALSE(open);
}

TEST(WalkWindow, ShowsWhatTheCameraSeesAndCloses) {
  const auto display = tests::VirtualDisplay::open(1400, 900);
  if (!display) GTEST_SKIP() << "Xvfb or xdotool is not installed: no window to test";
  const capture::Session session = capture::open_session(tests::sample_session());
  reconstruction::LiveWalk walk(
      {.session = "walk", .board = capture::read_board(*session.board), .camera = session.camera});
  const reconstruction::LiveHull hull(walk, "walk");
  const tests::TemporaryFolder folder;
  WalkWindow window(
      {.title = "test", .walk = walk, .hull = hull, .snapshot_folder = folder.path()});
  for (int i = 0; i < 3; ++i) window.redraw(0);
  display->act({"mousemove", "500", "300"});
  walk.look_at(*capture::open_frames(session)->next());
  window.redraw(0.05);
  display->act({"key", "--clearmodifiers", "F12"});
  const auto file = folder.path() / "sheen-001.png";
  for (int i = 0; i < kPatience && !std::filesystem::exists(file); ++i) window.redraw(0.02);
  // Before there is a hull the image fills the view: its sheet is brighter than any background.
  const cv::Mat shown = cv::imread(file.string());
  ASSERT_FALSE(shown.empty());
  const cv::Mat view = shown.colRange(0, shown.cols / 2);
  EXPECT_GT(cv::mean(view)[1], 60);
  display->act({"key", "--clearmodifiers", "q"});
  bool is_open = true;
  for (int i = 0; is_open && i < kPatience; ++i) is_open = window.redraw(0.02);
  EXPECT_FALSE(is_open);
}

TEST(StartWindow, ShowsACameraChoosesItAndCloses) {
  const auto display = tests::VirtualDisplay::open(1400, 900);
  if (!display) GTEST_SKIP() << "Xvfb or xdotool is not installed: no window to test";
  const tests::TemporaryFolder folder;
  setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
  const CameraAccess cameras{
      .list =
          [] {
            return std::vector<capture::CameraListing>{
                {.device = "/dev/locked", .name = "Locked", .fault = "belongs to another"},
                {.device = "/dev/played", .name = "Player"}};
          },
      .open = [](const std::string&) { return std::make_unique<tests::PlayingCamera>(); }};
  StartWindow window(cameras, folder.path());
  display->act({"mousemove", "500", "20"});
  // The first that works is chosen by itself.
  for (int i = 0; i < kPatience && window.choice().camera.empty(); ++i) window.redraw(0.02);
  EXPECT_EQ(window.choice().camera, "/dev/played");
  EXPECT_FALSE(window.is_busy());
  display->act({"key", "--clearmodifiers", "q"});
  bool is_open = true;
  for (int i = 0; is_open && i < kPatience; ++i) is_open = window.redraw(0.02);
  EXPECT_FALSE(is_open);
  unsetenv("XDG_STATE_HOME");
}

TEST(NoDisplay, IsOneClearError) {
  setenv("DISPLAY", ":9999", 1);
  unsetenv("WAYLAND_DISPLAY");
  const core::Mesh mesh = render::testing::tetrahedron(0.1f);
  const auto light_field = render::testing::random_mean(mesh.positions.size(), 0);
  try {
    PreviewWindow window({.title = "test",
                          .mesh = mesh,
                          .up = Eigen::Vector3d::UnitZ(),
                          .light_field = &light_field});
    FAIL() << "a window without a display";
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::Error::Kind::run_failed);
    EXPECT_NE(std::string(error.what()).find("DISPLAY"), std::string::npos);
  }
}

}  // namespace
}  // namespace sheen::app
