// SPDX-License-Identifier: MIT
#include "pipeline/mesh_stills.h"

#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>

namespace sheen::pipeline {
namespace {

// 8 images of at most 20 tags leave 8 x (160 - 6) numbers; 600 are asked for.
TEST(Stills, TellNothingOfAMeshWhereTheLensIsAnother) {
  const auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const core::CameraModel camera = capture::test::make_camera(480, 360, false);
  capture::Session session;
  session.camera = camera;
  session.board_from_object.translation() = Eigen::Vector3d(0.01, 0.02, 0.03);
  std::vector<PosedImage> images;
  for (int i = 0; i < 8; ++i) {
    const auto pose = capture::test::look_at_board(0.24, 0.9 + 0.05 * (i % 3), 0.8 * i);
    images.push_back({capture::test::render_board(board, camera, pose, {.supersampling = 2}),
                      &session.camera, pose * session.board_from_object});
  }
  ProgressSink sink;
  EXPECT_TRUE(are_poses_sound(session, board, images, sink));
  auto told = camera.intrinsics();
  told.distortion[0] = 0.15;
  session.camera = core::CameraModel(told);
  EXPECT_FALSE(are_poses_sound(session, board, images, sink));
  EXPECT_TRUE(are_poses_sound(session, std::nullopt, images, sink)) << "poses from a file";
}

}  // namespace
}  // namespace sheen::pipeline
