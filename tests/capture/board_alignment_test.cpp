// SPDX-License-Identifier: MIT
#include "capture/dataset/board_alignment.h"

#include "tests/capture/expect_bad_input.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sheen::capture::test {
namespace {

constexpr double kScale = 0.037;  // metres per unit

Eigen::Isometry3d some_motion() {
  Eigen::Isometry3d motion(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()));
  motion.translation() = Eigen::Vector3d(0.3, -0.1, 0.2);
  return motion;
}

/// Cameras that go round, with both of their poses.
std::vector<PosePair> alignment_walk(int count) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < count; ++i) {
    Eigen::Isometry3d world(Eigen::AngleAxisd(0.7 * i, Eigen::Vector3d(0.1, 1, 0.3).normalized()));
    world.translation() =
        Eigen::Vector3d(8 * std::cos(0.7 * i), 1 + 0.2 * i, 8 * std::sin(0.7 * i));
    Eigen::Isometry3d scaled = world;
    scaled.translation() *= kScale;
    pairs.push_back({world, some_motion() * scaled});
  }
  return pairs;
}

TEST(BoardAlignment, FindsASimilarityBack) {
  const BoardAlignment found = align_pairs(alignment_walk(7), "set");
  EXPECT_NEAR(found.metres_per_unit, kScale, 1e-12);
  EXPECT_TRUE(found.board_from_world.isApprox(some_motion(), 1e-9));
  EXPECT_LT(found.rms_m, 1e-12);
}

// Three images on one line say all: their rotations are known besides.
TEST(BoardAlignment, NeedsNoMoreThanALine) {
  std::vector<PosePair> pairs = alignment_walk(3);
  for (int i = 0; i < 3; ++i) {
    Eigen::Isometry3d scaled = pairs[i].world_from_camera;
    pairs[i].world_from_camera.translation() = Eigen::Vector3d(i, 0, 0);
    scaled.translation() = Eigen::Vector3d(kScale * i, 0, 0);
    pairs[i].board_from_camera = some_motion() * scaled;
  }
  EXPECT_TRUE(align_pairs(pairs, "set").board_from_world.isApprox(some_motion(), 1e-9));
}

// One of twenty pictures posed wrongly by 2 cm, of a walk 30 cm wide, is left out.
TEST(BoardAlignment, LeavesOutWhatIsFarOff) {
  std::vector<PosePair> pairs = alignment_walk(20);
  pairs[4].board_from_camera.translation().x() += 0.02;
  const BoardAlignment found = align_pairs(pairs, "set");
  EXPECT_LT(found.images, 20U);
  EXPECT_NEAR(found.metres_per_unit, kScale, 1e-9);
  EXPECT_TRUE(found.board_from_world.isApprox(some_motion(), 1e-6));
}

TEST(BoardAlignment, RefusesWhatSaysNothing) {
  expect_bad_input([] { align_pairs(alignment_walk(2), "set"); }, "set", "2 images");
  std::vector<PosePair> still(5, alignment_walk(1).front());
  expect_bad_input([&] { align_pairs(still, "set"); }, "set", "one place");
  std::vector<PosePair> mirrored = alignment_walk(9);
  for (PosePair& pair : mirrored) pair.board_from_camera.translation().z() *= -1;
  expect_bad_input([&] { align_pairs(mirrored, "set"); }, "set", "contradict");
}

}  // namespace
}  // namespace sheen::capture::test
