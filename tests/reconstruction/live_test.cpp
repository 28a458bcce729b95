// SPDX-License-Identifier: MIT
// A walk while it is filmed: the sample session, whose camera and object are known.
#include "capture/board_print/default_board.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "core/mesh/bounds.h"
#include "reconstruction/live/growing_hull.h"
#include "reconstruction/live/view_directions.h"
#include "tests/capture/rendered_board.h"
#include "tests/reconstruction/stage_for_tests.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace sheen::reconstruction {
namespace {

const std::filesystem::path kSample =
    std::filesystem::path(SHEEN_SOURCE_DIR) / "sample_data/glossy";

TEST(ViewDirections, EveryMiddleLiesInItsOwnDirection) {
  for (std::size_t i = 0; i < kViewDirections; ++i) {
    EXPECT_EQ(view_direction_of(0.4 * middle_of_direction(i)), i);
  }
  EXPECT_FALSE(view_direction_of({1, 0, 0.05}));  // 3 degrees above the sheet
  EXPECT_FALSE(view_direction_of({0.1, 0, 1}));   // 84
}

/// Looks at the sample's frames [0, end).
void watch(LiveWalk& walk, int end) {
  const capture::Session session = capture::open_session(kSample);
  const auto frames = capture::open_frames(session, 0, end);
  while (const auto frame = frames->next()) walk.look_at(*frame);
}

LiveWalk unknown_lens() {
  const capture::Session session = capture::open_session(kSample);
  core::CameraModel::Intrinsics guess;
  guess.width_px = session.camera.width_px();
  guess.height_px = session.camera.height_px();
  guess.focal_px.setConstant(1.0 * guess.width_px);  // true is .9, and a lens that bends
  guess.principal_px << 0.5 * (guess.width_px - 1), 0.5 * (guess.height_px - 1);
  return LiveWalk({.session = "walk",
                   .board = capture::read_board(*session.board),
                   .camera = core::CameraModel(guess),
                   .camera_is_guessed = true});
}

TEST(LiveWalk, FindsItsLensAndTheHullGrows) {
  LiveWalk walk = unknown_lens();
  watch(walk, 120);
  const WalkSight sight = walk.sight();
  EXPECT_EQ(sight.frames, 30);  // of 120, one in four: 4 / 30 s is the first time after .12 s
  ASSERT_TRUE(sight.camera_from_board);
  // The sample's camera; corners of 30 views tell the focal length to a few px.
  EXPECT_NEAR(sight.camera.intrinsics().focal_px.x(), 576, 6);
  const auto views = walk.views();
  ASSERT_TRUE(views);
  EXPECT_EQ(views->views.size() + sight.missing.size(), kViewDirections);
  EXPECT_EQ(views->camera.width_px(), 213);  // a third

  GrowingHull hull("walk");
  ASSERT_TRUE(hull.step(*views));
  while (hull.step(*views)) {
  }
  EXPECT_EQ(hull.news().doubt, "");
  ASSERT_TRUE(hull.news().hull);
  // The knot is 140.4 x 138.6 x 87 mm on the board; cells of 4 mm, pixels of 2 mm, and outlines
  // bound it from outside: no view is low enough to see its top across.
  const Eigen::Vector3f size_mm = 1e3F * core::bounds_of(*hull.news().hull).sizes();
  EXPECT_NEAR(size_mm.x(), 142, 6);
  EXPECT_NEAR(size_mm.y(), 140, 6);
  EXPECT_GT(size_mm.z(), 87 - 4);
  EXPECT_LT(size_mm.z(), 87 + 16);
}

TEST(LiveWalk, SaysAtOnceThatTheBoardIsAnotherOne) {
  const capture::Session session = capture::open_session(kSample);
  LiveWalk walk({.session = "walk", .board = std::nullopt, .camera = session.camera});
  try {
    watch(walk, 1);
    FAIL() << "the sample's ids 0, ... are none of the default sheet's";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("walk: its first image shows another board"),
              std::string::npos)
        << error.what();
  }
}

TEST(LiveWalk, RecognisesTheDefaultSheetByItsIds) {
  const core::CameraModel camera = capture::test::make_camera(640, 480, false);
  const capture::Board sheet = capture::default_board(capture::kDefaultSheets[0]);
  LiveWalk walk({.session = "walk", .board = std::nullopt, .camera = camera});
  EXPECT_EQ(walk.sight().missing.size(), kViewDirections);
  // Half a second apart and 90 degrees: four directions.
  for (int i = 0; i < 4; ++i) {
    const auto pose = capture::test::look_at_board(0.4, 0.8, 1.57 * i + 0.2);
    walk.look_at({.image = capture::test::render_board(sheet, camera, pose, {.supersampling = 2}),
                  .time_s = 0.5 * i,
                  .index = i});
    const WalkSight sight = walk.sight();
    ASSERT_TRUE(sight.middle);
    ASSERT_TRUE(sight.camera_from_board);
    EXPECT_LT((sight.camera_from_board->translation() - pose.translation()).norm(), 0.002);
    EXPECT_EQ(sight.missing.size(), kViewDirections - 1 - static_cast<std::size_t>(i));
  }
  EXPECT_EQ(walk.views().value().board.tags.size(), sheet.tags.size());
}

TEST(GrowingHull, WaitsForEightViewsAndDoubtsAnEmptySheet) {
  const capture::Session session = capture::open_session(kSample);
  const capture::Board board = capture::read_board(*session.board);
  WalkViews walk{board, tests::small_camera(160, 120), {}, 0};
  GrowingHull hull("walk");
  const auto poses = tests::ring_of_poses(16, 0.5, 45, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < 16; ++i) {
    // Again with a third more views, 4/3 of 8 and of 11.
    EXPECT_EQ(hull.step(walk), i == 8 || i == 11 || i == 15) << i;
    walk.views.push_back(
        {static_cast<int>(i), cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(200)), poses[i]});
  }
  EXPECT_FALSE(hull.news().hull);
  EXPECT_NE(hull.news().doubt.find("walk: no object is found on the sheet"), std::string::npos)
      << hull.news().doubt;
}

}  // namespace
}  // namespace sheen::reconstruction
