// SPDX-License-Identifier: MIT
#include "capture/plausibility/board_check.h"
#include "capture/plausibility/scene_check.h"
#include "capture/plausibility/unit_guess.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/rendered_board.h"
#include "tests/core/shapes.h"

#include <gtest/gtest.h>

namespace sheen::capture::test {
namespace {

/// A board as `sheen board` prints it: 40 mm tags, 50 mm apart, 9 x 9.
Board usual_board(double scale = 1) {
  return make_grid_board("tag36h11", 9, 9, 0.04 * scale, 0.05 * scale);
}

/// A ball of 0.14 m in the middle of the board, seen from 0.5 m by a camera of 600 px.
struct Scene {
  explicit Scene(double object_scale = 1, double board_scale = 1)
      : mesh(core::testing::sphere(12, 16)), board(usual_board(board_scale)) {
    for (auto& position : mesh.positions) position *= static_cast<float>(0.07 * object_scale);
    session.folder = "session";
    session.board = "session/board.yaml";
    session.mesh = "session/object.ply";
    session.camera = core::CameraModel(
        {.width_px = 640, .height_px = 480, .focal_px = {600, 600}, .principal_px = {320, 240}});
    Eigen::AlignedBox3d box;
    for (const auto& [id, tag] : board.tags) box.extend(tag.board_from_tag.translation());
    session.board_from_object.translation() = box.center();
  }

  /// From straight above the object.
  [[nodiscard]] Eigen::Isometry3d view_from(double distance_m) const {
    Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
    board_from_camera.linear() = Eigen::DiagonalMatrix<double, 3>(1, -1, -1);
    board_from_camera.translation() =
        session.board_from_object.translation() + Eigen::Vector3d(0, 0, distance_m);
    return board_from_camera.inverse();
  }

  core::Mesh mesh;
  Board board;
  Session session;
};

void look(SceneCheck& check, const Scene& scene, double distance_m) {
  for (int i = 0; i < 10; ++i) check.see(scene.view_from(distance_m));
}

TEST(SceneCheck, HasNothingToSayAboutAnOrdinaryScene) {
  // Also at a tenth and three times of it: watches and chairs.
  for (const double scale : {0.1, 1.0, 3.0}) {
    SCOPED_TRACE(scale);
    const Scene scene(scale, scale);
    SceneCheck check(scene.session, scene.mesh, &scene.board);
    EXPECT_EQ(check.check_sizes(), std::vector<std::string>());
    look(check, scene, 0.5 * scale);
    EXPECT_NO_THROW(check.check_views());
    EXPECT_EQ(check.doubts(), std::vector<std::string>());
  }
}

TEST(SceneCheck, BoardsInOtherUnitsAreNamed) {
  const auto refuse = [](double board_scale, const char* unit) {
    const Scene scene(1, board_scale);
    const SceneCheck check(scene.session, scene.mesh, &scene.board);
    expect_bad_input([&] { static_cast<void>(check.check_sizes()); }, "board.yaml", unit);
  };
  refuse(1000, "millimetres");
  refuse(100, "centimetres");
}

TEST(SceneCheck, ABoardInInchesIsNotedOrRefusedWithItsUnit) {
  // 40 mm is 1.57 inches: read as 1.57 m, eleven times the object.
  const Scene scene(1, 1 / 0.0254);
  SceneCheck check(scene.session, scene.mesh, &scene.board);
  expect_bad_input([&] { static_cast<void>(check.check_sizes()); }, "board.yaml", "inches");
}

TEST(SceneCheck, PosesInOtherUnitsShowAnObjectOfNoPixels) {
  // Poses in millimetres: the camera stands 500 m away, and 0.14 m are 0.2 pixels wide.
  Scene scene;
  scene.session.board.reset();
  scene.session.poses = "session/poses.txt";
  SceneCheck check(scene.session, scene.mesh, nullptr);
  EXPECT_EQ(check.check_sizes(), std::vector<std::string>());
  look(check, scene, 500);
  expect_bad_input([&] { check.check_views(); }, "poses.txt", "millimetres", "pixels");
}

TEST(SceneCheck, APlaceFarFromTheCamerasNamesTheTransform) {
  // Poses and mesh in metres, the place in millimetres: 297 m away, and the cameras round the
  // origin of their poses.
  Scene scene;
  const auto there = scene.view_from(0.5);
  scene.session.board.reset();
  scene.session.poses = "session/poses.txt";
  scene.session.board_from_object.translation() = Eigen::Vector3d(220, 200, 0);
  SceneCheck check(scene.session, scene.mesh, nullptr);
  for (int i = 0; i < 10; ++i) check.see(there);
  expect_bad_input([&] { check.check_views(); }, "session.json", "T_stage_object", "millimetres");
}

TEST(SceneCheck, AnObjectOutsideOfMostImagesIsADoubt) {
  const Scene scene;
  SceneCheck check(scene.session, scene.mesh, &scene.board);
  look(check, scene, 0.5);
  EXPECT_TRUE(check.doubts().empty());
  // From the same places, looking away.
  const Eigen::Isometry3d away(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX()));
  for (int i = 0; i < 11; ++i) check.see(away * scene.view_from(0.5));
  ASSERT_EQ(check.doubts().size(), 1u);
  EXPECT_NE(check.doubts()[0].find("outside of the image in 11 of 21 views"), std::string::npos);
}

TEST(SceneCheck, CamerasInsideOfTheObjectAreRefused) {
  // A mesh in decimetres round the cameras.
  Scene scene(10);
  scene.session.board.reset();
  scene.session.poses = "session/poses.txt";
  SceneCheck check(scene.session, scene.mesh, nullptr);
  look(check, scene, 0.4);
  expect_bad_input([&] { check.check_views(); }, "object.ply", "inside");
}

TEST(SceneCheck, OneCameraInsideIsADoubtOnly) {
  const Scene scene;
  SceneCheck check(scene.session, scene.mesh, &scene.board);
  look(check, scene, 0.5);
  check.see(scene.view_from(0.01));
  EXPECT_NO_THROW(check.check_views());
  ASSERT_EQ(check.doubts().size(), 1u);
  EXPECT_NE(check.doubts()[0].find("inside"), std::string::npos);
}

TEST(SceneCheck, APlaceFarFromTheBoardNamesTheTransform) {
  Scene scene;
  // In millimetres.
  scene.session.board_from_object.translation() = Eigen::Vector3d(220, 200, 0);
  const SceneCheck check(scene.session, scene.mesh, &scene.board);
  expect_bad_input([&] { static_cast<void>(check.check_sizes()); }, "T_stage_object",
                   "millimetres");
}

TEST(BoardCheck, TagsThatOverlapOrStandFarApartAreRefused) {
  const auto with = [](double size_m, double pitch_m) {
    return make_grid_board("tag36h11", 4, 4, size_m, pitch_m);
  };
  EXPECT_EQ(check_board(with(0.04, 0.05), "board.yaml"), std::vector<std::string>());
  // Sizes in millimetres, places in metres, and the other way round.
  expect_bad_input([&] { static_cast<void>(check_board(with(40, 0.05), "board.yaml")); }, "overlap",
                   "millimetres");
  expect_bad_input([&] { static_cast<void>(check_board(with(0.04, 50), "board.yaml")); },
                   "millimetres", "x, y, z");
  // By a hair: noted.
  EXPECT_EQ(check_board(with(0.051, 0.05), "board.yaml").size(), 1u);
}

TEST(BoardCheck, SizesThatNobodyPrintsAreRefusedOrNoted) {
  const auto with = [](double size_m) {
    return make_grid_board("tag36h11", 2, 2, size_m, 1.3 * size_m);
  };
  for (const double usual : {0.006, 0.04, 0.25}) {
    EXPECT_EQ(check_tag_size(with(usual), "board.yaml"), std::vector<std::string>());
  }
  EXPECT_EQ(check_tag_size(with(2), "board.yaml").size(), 1u);  // a building site, or inches
  expect_bad_input([&] { static_cast<void>(check_tag_size(with(45), "board.yaml")); },
                   "millimetres");
  expect_bad_input([&] { static_cast<void>(check_tag_size(with(4e-5), "board.yaml")); }, "metres");
}

TEST(UnitGuess, NamesEveryUnitThatFits) {
  EXPECT_EQ(unit_guess(40, 0.004, 0.3), "millimetres");
  EXPECT_EQ(unit_guess(1.5, 0.01, 0.3), "centimetres or inches");
  EXPECT_EQ(unit_guess(0.04, 0.04, 0.3), "");
  EXPECT_EQ(unit_question(0.04, 0.04, 0.3, "give metres"), "give metres");
}

}  // namespace
}  // namespace sheen::capture::test
