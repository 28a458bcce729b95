// SPDX-License-Identifier: MIT
// A printed ball and meshes of it that are of another size or elsewhere by a known way.
#include "pipeline/mesh_placement.h"

#include "tests/capture/rendered_board.h"
#include "tests/pipeline/printed_ball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace sheen::pipeline {
namespace {

using test::kBallRadius_m;

constexpr int kImages = 32;
constexpr double kDistance_m = 0.22;

class PlaceMesh : public testing::Test {
 protected:
  /// `how(frame)` says how each frame is taken, three times round the ball.
  std::vector<PosedImage> images(
      const std::function<void(int frame, test::BallPhotograph&)>& how = {}) const {
    std::vector<PosedImage> taken;
    for (int i = 0; i < kImages; ++i) {
      const Eigen::Isometry3d pose = capture::test::look_at_board(
          kDistance_m, 0.7 + 0.3 * std::sin(0.9 * i), 2 * std::numbers::pi * 3 * i / kImages);
      test::BallPhotograph photograph{.background = {40, 120, 30}};
      if (how) how(i, photograph);
      taken.push_back({test::photograph(camera_, pose, photograph), &camera_, pose});
    }
    return taken;
  }

  std::optional<MeshPlacement> place(const core::Mesh& mesh, const std::vector<PosedImage>& images,
                                     int threads = 1) {
    return place_mesh(mesh, images, threads, sink_);
  }

  core::CameraModel camera_ = capture::test::make_camera(320, 240, false);
  core::Mesh ball_ = test::ball();
  ProgressSink sink_;
};

core::Mesh moved(core::Mesh mesh, double scale, const Eigen::Vector3d& shift_m) {
  for (Eigen::Vector3f& position : mesh.positions) {
    position = static_cast<float>(scale) * position + shift_m.cast<float>();
  }
  return mesh;
}

double rms_distance(const core::Mesh& a, const core::Mesh& b) {
  double square = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    square += static_cast<double>((a.positions[i] - b.positions[i]).squaredNorm());
  }
  return std::sqrt(square / static_cast<double>(a.positions.size()));
}

TEST_F(PlaceMesh, ARightMeshStays) {
  EXPECT_FALSE(place(ball_, images()));
  EXPECT_FALSE(place(ball_, images([](int, auto& how) { how.is_glossy = true; })));
}

// At .22 m and 251 px of focal length 1 mm is 1.1 px, and 3 % of the radius 1.5 mm. A facet's edges
// lie up to 1 - cos(5 degrees) = .4 % of the radius within the ball: .2 mm.
TEST_F(PlaceMesh, SizeAndPlaceAreFound) {
  for (const bool is_glossy : {false, true}) {
    const auto taken = images([&](int, auto& how) { how.is_glossy = is_glossy; });
    for (const double scale : {0.97, 1.0, 1.03}) {
      for (const Eigen::Vector3d& shift_m :
           {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.001, -0.0008, 0.0006)}) {
        if (scale == 1 && shift_m.isZero()) continue;
        const core::Mesh given = moved(ball_, scale, shift_m);
        const auto placed = place(given, taken);
        ASSERT_TRUE(placed) << scale << " " << shift_m.transpose();
        EXPECT_LT(rms_distance(placed->mesh, ball_), 2.5e-4) << scale << " " << shift_m.transpose();
        EXPECT_NEAR(placed->growth, 1 / scale - 1, 0.006);
        EXPECT_LT((placed->shift_m + shift_m).norm(), 2.5e-4);
        const bool is_size = std::abs(scale - 1) * kBallRadius_m > shift_m.norm();
        EXPECT_EQ(placed->finding(kIsPutRight).cause, is_size ? "mesh-size" : "mesh-place");
      }
    }
  }
}

// Outlines alone would make the mesh larger: what lies round the ball has its colours. The print
// would then be seen 2 mm too near, and says no.
TEST_F(PlaceMesh, PrintHasTheLastWord) {
  EXPECT_FALSE(place(ball_, images([](int, auto& how) { how.halo = 0.04; })));
}

// Half of the way would halve the residual's square, and fit neither half of the recording.
TEST_F(PlaceMesh, AnObjectThatMovedIsInNoPlace) {
  EXPECT_FALSE(place(ball_, images([](int frame, auto& how) {
                       if (frame >= kImages / 2) how.middle_m = {0.002, 0, 0};
                     })));
}

// A flat disc instead of a ball: no place and no size has its outline in all views.
TEST_F(PlaceMesh, AnotherShapeIsLeftWhereItIs) {
  core::Mesh disc = ball_;
  for (Eigen::Vector3f& position : disc.positions) {
    position =
        Eigen::Vector3f(1.2f * position.x(), 1.2f * position.y(), 0.1f * position.z() + 0.04f);
  }
  EXPECT_FALSE(place(disc, images()));
}

TEST_F(PlaceMesh, IsTheSameOnAnyNumberOfThreads) {
  const core::Mesh given = moved(ball_, 1.02, {0.001, 0, 0});
  const auto taken = images();
  const auto one = place(given, taken, 1), three = place(given, taken, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->mesh.positions, three->mesh.positions);
  EXPECT_EQ(one->residual_change, three->residual_change);
}

TEST_F(PlaceMesh, TooFewImagesTellNothing) {
  const core::Mesh given = moved(ball_, 1.03, {0, 0, 0});
  auto taken = images();
  EXPECT_FALSE(place(given, {}));
  taken.resize(5);
  EXPECT_FALSE(place(given, taken));
}

}  // namespace
}  // namespace sheen::pipeline
