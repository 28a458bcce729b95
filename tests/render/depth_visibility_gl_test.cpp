// SPDX-License-Identifier: MIT
// The depth pass against rays from every vertex.
#include "core/mesh/read_mesh.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/ray_visibility.h"
#include "render/visibility/depth_visibility.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <string>

namespace sheen::render {
namespace {

using core::VertexRejection;

struct Agreement {
  std::size_t candidates = 0;
  std::size_t visible = 0;        ///< by rays
  std::size_t false_visible = 0;  ///< hidden by rays, seen by depth
  std::size_t false_hidden = 0;   ///< the other way round

  [[nodiscard]] double share(std::size_t count) const {
    return static_cast<double>(count) / static_cast<double>(candidates);
  }
};

/// Both on the same candidates, from a few sides.
Agreement compare(const core::Mesh& mesh, const core::CameraModel& camera, double distance_m) {
  const auto context = make_osmesa_context();
  const auto by_depth = make_depth_visibility(*context, mesh);
  const auto by_rays = core::make_ray_visibility(mesh, 1);
  const core::SurfacePoints points = core::surface_points(mesh);
  Agreement result;
  for (const Eigen::Vector3d& side :
       {Eigen::Vector3d(1, 0.1, 0.2), Eigen::Vector3d(-0.4, 1, 0.7), Eigen::Vector3d(0.3, -0.8, 1),
        Eigen::Vector3d(-1, -0.5, -0.3)}) {
    const Eigen::Isometry3d pose = testing::looking_at_origin(side, distance_m);
    core::VertexView depth_view;
    core::project_vertices(points, camera, pose, {}, 1, depth_view);
    core::VertexView ray_view = depth_view;
    const core::VertexView before = depth_view;
    by_depth->reject_occluded(camera, pose, depth_view);
    by_rays->reject_occluded(camera, pose, ray_view);
    for (std::size_t i = 0; i < before.rejection.size(); ++i) {
      // Vertices rejected before stay as they were.
      if (before.rejection[i] != VertexRejection::none) {
        EXPECT_EQ(depth_view.rejection[i], before.rejection[i]);
        continue;
      }
      const bool depth_sees = depth_view.rejection[i] == VertexRejection::none;
      const bool ray_sees = ray_view.rejection[i] == VertexRejection::none;
      ++result.candidates;
      result.visible += ray_sees ? 1 : 0;
      result.false_visible += depth_sees && !ray_sees ? 1 : 0;
      result.false_hidden += !depth_sees && ray_sees ? 1 : 0;
    }
  }
  return result;
}

/// At least 99 % alike, and neither error more than `largest_share` of the candidates.
void expect_agreement(const Agreement& found, const std::string& what, double largest_share) {
  ASSERT_GT(found.candidates, 1000u);
  std::cout << what << ": " << found.candidates << " candidates, " << found.visible
            << " visible, false-visible " << 100 * found.share(found.false_visible)
            << " %, false-hidden " << 100 * found.share(found.false_hidden) << " %\n";
  EXPECT_LE(found.share(found.false_visible + found.false_hidden), 0.01);
  EXPECT_LE(found.share(found.false_visible), largest_share);
  EXPECT_LE(found.share(found.false_hidden), largest_share);
}

// A sphere hides none of the vertices that face the camera: every rejection would be false.
TEST(DepthVisibility, SphereHidesNothing) {
  for (const int rings : {8, 40, 125}) {
    const Agreement found =
        compare(testing::sphere(0.1f, rings), testing::plain_camera(1280, 720), 0.45);
    EXPECT_EQ(found.visible, found.candidates);
    EXPECT_EQ(found.false_hidden, 0u) << rings << " rings";
  }
}

TEST(DepthVisibility, SphereUnderDistortionHidesNothing) {
  for (const int rings : {8, 40, 125}) {
    const Agreement found =
        compare(testing::sphere(0.1f, rings), testing::distorted_camera(1280, 720), 0.45);
    EXPECT_EQ(found.visible, found.candidates);
    EXPECT_EQ(found.false_hidden, 0u) << rings << " rings";
  }
}

TEST(DepthVisibility, TorusKnotAgreesWithRays) {
  const core::Mesh mesh = testing::torus_knot(0.2f, 600, 40);
  const Agreement plain = compare(mesh, testing::plain_camera(1280, 720), 0.45);
  expect_agreement(plain, "torus knot", 0.01);
  EXPECT_GT(plain.share(plain.candidates - plain.visible), 0.05) << "nothing to find out";
  expect_agreement(compare(mesh, testing::distorted_camera(1280, 720), 0.45),
                   "torus knot, distorted", 0.01);
}

// Triangles of many pixels, some of them large enough for tessellation.
TEST(DepthVisibility, CoarseTorusKnotUnderDistortion) {
  expect_agreement(
      compare(testing::torus_knot(0.2f, 120, 12), testing::distorted_camera(1280, 720), 0.45),
      "coarse torus knot, distorted", 0.01);
}

TEST(DepthVisibility, BunnyAgreesWithRays) {
  const std::filesystem::path path = SHEEN_SHARED_DATA "/meshes/bunny.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  core::Mesh mesh = core::read_mesh(path);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
  for (Eigen::Vector3f& position : mesh.positions) {
    position = 0.2f / box.diagonal().norm() * (position - box.center());
  }
  expect_agreement(compare(mesh, testing::plain_camera(1280, 720), 0.45), "bunny", 0.01);
  expect_agreement(compare(mesh, testing::distorted_camera(1280, 720), 0.45), "bunny, distorted",
                   0.01);
}

}  // namespace
}  // namespace sheen::render
