// SPDX-License-Identifier: MIT
#include "core/visibility/ray_caster.h"
#include "core/visibility/ray_visibility.h"
#include "tests/core/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sheen::core {
namespace {

using testing::camera_above;
using testing::sphere;
using testing::square_grid;
using testing::together;

const CameraModel kCamera({640, 480, {300, 300}, {320, 240}, {}});

/// A camera at (0, 0, height) that looks down the z axis.
VertexView seen_from_above(const Mesh& mesh, double height, int threads = 1) {
  VertexView view;
  const Eigen::Isometry3d pose = camera_above(height);
  project_vertices(surface_points(mesh), kCamera, pose, {}, threads, view);
  make_ray_visibility(mesh, threads)->reject_occluded(kCamera, pose, view);
  return view;
}

TEST(RayVisibility, ConvexSurfaceHidesNothingOfItself) {
  const Mesh mesh = sphere(40, 80);
  const VertexView view = seen_from_above(mesh, 3.0);
  const auto counts = count_rejections(view);
  EXPECT_EQ(counts[static_cast<std::size_t>(VertexRejection::occluded)], 0u);
  // Seen up to the cosine 0.2, which by the law of sines is reached at sin(angle at eye) =
  // sqrt(0.96) / 3: polar angle acos(0.2) - asin(0.3266) = 78.46 - 19.06 = 59.40 degrees, ring 13
  // of 4.5 degrees (58.5); with the pole 1 + 13 * 80 vertices.
  EXPECT_EQ(counts[static_cast<std::size_t>(VertexRejection::none)], 1u + 13u * 80u);
}

TEST(RayVisibility, ParallelSquaresHideByTheRuleOfThree) {
  const Mesh back = square_grid(20, 2.0f, 0.0f);
  const Mesh mesh = together(back, square_grid(1, 0.5f, 1.0f));
  const VertexView view = seen_from_above(mesh, 3.0);
  // From z = 3 a square of half side 0.5 in z = 1 covers half side 0.5 * 3 / 2 = 0.75 of z = 0.
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const bool in_back = i < back.positions.size();
    const bool hidden = in_back && mesh.positions[i].head<2>().cwiseAbs().maxCoeff() < 0.75f;
    EXPECT_EQ(view.rejection[i], hidden ? VertexRejection::occluded : VertexRejection::none)
        << mesh.positions[i].transpose();
  }
}

TEST(RayVisibility, FacesSeenFromBehindDoNotHide) {
  Mesh front = square_grid(1, 0.5f, 1.0f);
  for (auto& triangle : front.triangles) std::swap(triangle[1], triangle[2]);
  const VertexView view = seen_from_above(together(square_grid(20, 2.0f, 0.0f), front), 3.0);
  EXPECT_EQ(count_rejections(view)[static_cast<std::size_t>(VertexRejection::occluded)], 0u);
}

TEST(RayVisibility, CreaseIsSeenFromItsOpenSideAndHiddenBehindItsWall) {
  // A floor (z = 0, facing up) that meets a wall (x = 1, facing -x); the crease's vertices twice,
  // as a hard edge has them.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                    {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.normals.insert(mesh.normals.end(), 4, Eigen::Vector3f(-1, 0, 0));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  const RayCaster caster(mesh);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_FALSE(caster.vertex_hidden(i, {-1.0f, 0.4f, 0.3f})) << i;
    EXPECT_FALSE(caster.vertex_hidden(i, {0.999f, 0.4f, 2.0f})) << i;
  }
  // The same crease with a lid over the floor, facing up: hidden from above the lid.
  mesh.positions.insert(mesh.positions.end(),
                        {{-9, -9, 0.01f}, {9, -9, 0.01f}, {9, 9, 0.01f}, {-9, 9, 0.01f}});
  mesh.normals.insert(mesh.normals.end(), 4, Eigen::Vector3f(0, 0, 1));
  mesh.triangles.insert(mesh.triangles.end(), {{8, 9, 10}, {8, 10, 11}});
  const RayCaster covered(mesh);
  for (const std::uint32_t i : {0u, 1u, 2u, 3u, 4u, 5u}) {
    EXPECT_TRUE(covered.vertex_hidden(i, {0.5f, 0.4f, 2.0f})) << i;
  }
}

TEST(RayVisibility, ThreadsDoNotMatter) {
  const Mesh mesh = together(sphere(60, 60), square_grid(40, 0.8f, 1.5f));
  const VertexView expected = seen_from_above(mesh, 4.0, 1);
  EXPECT_GT(count_rejections(expected)[static_cast<std::size_t>(VertexRejection::occluded)], 100u);
  for (int threads = 2; threads <= 8; ++threads) {
    EXPECT_EQ(seen_from_above(mesh, 4.0, threads).rejection, expected.rejection) << threads;
  }
}

TEST(RayCaster, MeetsTheSphereWhereTheEquationSays) {
  const RayCaster caster(sphere(200, 400));
  for (int i = 0; i < 50; ++i) {
    const float x = -0.9f + 0.036f * static_cast<float>(i);
    const auto hit = caster.first_hit({x, 0.1f, 5.0f}, {0, 0, -2}, 0, 100);
    ASSERT_TRUE(hit);
    // z = sqrt(1 - x^2 - y^2), direction of length 2. Chords of 0.9 degrees lie at most
    // 1 - cos(0.45 degrees) = 3.1e-5 per direction of the grid below the sphere, seen at a slope of
    // at most 1 / z.
    const float z = std::sqrt(1 - x * x - 0.01f);
    EXPECT_NEAR(5 - 2 * hit->distance, z, 6.2e-5f / z);
    EXPECT_TRUE(hit->front_face);
    EXPECT_NEAR(hit->barycentric.sum(), 1, 1e-6);
  }
}

TEST(RayCaster, BarycentricWeightsBelongToTheCorners) {
  const Mesh mesh = square_grid(5, 1.0f, 0.0f);
  const RayCaster caster(mesh);
  const auto hit = caster.first_hit({0.23f, -0.57f, -1.0f}, {0, 0, 1}, 0, 10);
  ASSERT_TRUE(hit);
  EXPECT_FALSE(hit->front_face);
  EXPECT_FLOAT_EQ(hit->distance, 1.0f);
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    point += hit->barycentric[corner] * mesh.positions[mesh.triangles[hit->triangle_idx][corner]];
  }
  EXPECT_LT((point - Eigen::Vector3f(0.23f, -0.57f, 0)).norm(), 1e-6f);
}

TEST(RayCaster, LooksBetweenNearAndFarOnly) {
  const RayCaster caster(square_grid(1, 1.0f, 0.0f));
  const Eigen::Vector3f origin(0.3f, 0.1f, 1.0f);
  const Eigen::Vector3f down(0, 0, -1);
  EXPECT_TRUE(caster.occluded(origin, down, 0.0f, 2.0f));
  EXPECT_FALSE(caster.occluded(origin, down, 1.1f, 2.0f));
  EXPECT_FALSE(caster.occluded(origin, down, 0.0f, 0.9f));
  EXPECT_FALSE(caster.first_hit(origin, down, 0.0f, 0.9f));
  EXPECT_FALSE(caster.first_hit(origin, -down, 0.0f, 9.0f));
}

TEST(RayCaster, MeshWithoutTrianglesHidesNothing) {
  const RayCaster caster(Mesh{});
  EXPECT_FALSE(caster.first_hit({0, 0, 0}, {0, 0, 1}, 0, 10));
}

}  // namespace
}  // namespace sheen::core
