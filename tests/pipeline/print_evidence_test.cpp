// SPDX-License-Identifier: MIT
// A printed ball that is shifted by a known way from a known frame on.
#include "pipeline/evidence/print_evidence.h"

#include "core/samples/surface_points.h"
#include "core/visibility/raster_visibility.h"
#include "pipeline/view_observer.h"
#include "tests/capture/rendered_board.h"
#include "tests/pipeline/printed_ball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sheen::pipeline {
namespace {

using capture::test::look_at_board;

constexpr int kFrames = 48, kMoved = 26;

struct Moved {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  bool is_glossy = false;
  double mesh_scale = 1;
};

PrintEvidence seen(const core::Mesh& mesh, const Moved& moved) {
  const core::CameraModel camera = capture::test::make_camera(320, 240, false);
  ViewObserver observer(mesh, core::make_raster_visibility(mesh, 1), {}, 1);
  PrintEvidence evidence(mesh);
  for (int i = 0; i < kFrames; ++i) {
    // Three times round, up and down.
    const Eigen::Isometry3d pose =
        look_at_board(0.22, 0.7 + 0.3 * std::sin(0.9 * i), 2 * std::numbers::pi * 3 * i / kFrames);
    test::BallPhotograph how{.is_glossy = moved.is_glossy};
    if (i >= kMoved) how.middle_m = moved.shift_m;
    const cv::Mat image = test::photograph(camera, pose, how);
    evidence.look_at(i, image, observer.see(camera, pose), camera, pose);
  }
  return evidence;
}

// 1 mm at .22 m and 251 px of focal length is 1.1 px. What a first-order model of a print of 8 mm
// makes of it is short by a sixth: sin(x) / x for x = 2 pi / 8 is .90, twice smoothed by 1 px.
TEST(PrintEvidence, AShiftIsFoundWithItsFrame) {
  const core::Mesh mesh = test::ball();
  const Eigen::Vector3d shift(0.0008, -0.0005, 0.0003);
  for (const bool is_glossy : {false, true}) {
    const PrintEvidence evidence = seen(mesh, {shift, is_glossy});
    const auto jump = evidence.jump();
    ASSERT_TRUE(jump);
    EXPECT_EQ(jump->frame_index, kMoved);
    EXPECT_LT((jump->shift_m - shift).norm(), 0.25 * shift.norm()) << jump->shift_m.transpose();
    ASSERT_EQ(evidence.findings().size(), 1u);
    EXPECT_EQ(evidence.findings()[0].cause, "object-moved");
  }
}

// Gloss, and a mesh that is 3 % too large, do not look like an object that moves.
TEST(PrintEvidence, AnObjectAtRestIsNotTakenForOneThatMoves) {
  const core::Mesh mesh = test::ball();
  EXPECT_TRUE(seen(mesh, {}).findings().empty());
  EXPECT_TRUE(seen(mesh, {.is_glossy = true}).findings().empty());
  core::Mesh large = mesh;
  for (Eigen::Vector3f& position : large.positions) position *= 1.03f;
  EXPECT_TRUE(seen(large, {.is_glossy = true}).findings().empty());
}

TEST(PrintEvidence, NothingSeenTellsNothing) {
  const core::Mesh mesh = test::ball();
  EXPECT_FALSE(PrintEvidence(mesh).jump());
}

}  // namespace
}  // namespace sheen::pipeline
