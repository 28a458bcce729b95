// SPDX-License-Identifier: MIT
#include "reconstruction/refine/normal_filter.h"
#include "reconstruction/surface/edge_mesh.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/surface/remesh.h"
#include "reconstruction/surface/self_intersection.h"
#include "reconstruction/surface/triangle_tree.h"
#include "reconstruction/surface/untangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace sheen::reconstruction {
namespace {

template <typename Distance>
DistanceGrid grid_of(const Distance& distance, float cell_m) {
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(1.5F);
  DistanceGrid grid({-reach, reach}, cell_m, 1);
  for (std::size_t i = 0; i < grid.count(); ++i) grid[i] = distance(grid.point(i));
  return grid;
}

float ball(const Eigen::Vector3f& p) {
  return p.norm() - 1;
}

/// A ring of radius 1 and a tube of radius .4.
float torus(const Eigen::Vector3f& p) {
  return std::hypot(p.head<2>().norm() - 1, p.z()) - 0.4F;
}

float cube(const Eigen::Vector3f& p) {
  return p.cwiseAbs().maxCoeff() - 1;
}

/// Vertices - edges + triangles; a closed surface has 3/2 as many edges as triangles.
long euler_number(const core::Mesh& mesh) {
  return static_cast<long>(mesh.positions.size()) - static_cast<long>(mesh.triangles.size() / 2);
}

double volume_of(const core::Mesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    volume += mesh.positions[t[0]].cast<double>().dot(
                  mesh.positions[t[1]].cast<double>().cross(mesh.positions[t[2]].cast<double>())) /
              6;
  }
  return volume;
}

TEST(MarchingTetrahedra, MakesClosedSurfacesOfTheRightKindAndSize) {
  const core::Mesh sphere = march_tetrahedra(grid_of(ball, 0.1F));
  EXPECT_TRUE(is_closed_manifold(sphere));
  EXPECT_EQ(euler_number(sphere), 2);
  EXPECT_TRUE(find_self_intersections(sphere, 2).empty());
  // Chords of length up to sqrt(3) h lie within h^2 3/8 of the ball: less than 1.2 % of its volume.
  EXPECT_NEAR(volume_of(sphere), 4 * std::numbers::pi / 3, 0.05);
  const core::Mesh ring = march_tetrahedra(grid_of(torus, 0.1F));
  EXPECT_TRUE(is_closed_manifold(ring));
  EXPECT_EQ(euler_number(ring), 0);
}

TEST(MarchingTetrahedra, NoiseCannotBreakIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> noise(-0.6F, 0.6F);
  const core::Mesh mesh =
      march_tetrahedra(grid_of([&](const auto& p) { return ball(p) + noise(random); }, 0.2F));
  EXPECT_TRUE(is_closed_manifold(mesh));
  EXPECT_TRUE(find_self_intersections(mesh, 1).empty());
}

TEST(Remesh, KeepsSurfaceAndTopologyAndMakesEdgesEven) {
  const ProjectOntoSurface onto_ball = [](const Eigen::Vector3f& p) {
    return Eigen::Vector3f(p.normalized());
  };
  const core::Mesh mesh = remesh(march_tetrahedra(grid_of(ball, 0.1F)), 0.2F, 5, onto_ball);
  EXPECT_TRUE(is_closed_manifold(mesh));
  EXPECT_EQ(euler_number(mesh), 2);
  EXPECT_TRUE(find_self_intersections(mesh, 1).empty());
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const float length = (mesh.positions[t[c]] - mesh.positions[t[(c + 1) % 3]]).norm();
      EXPECT_LT(length, 2 * 0.2F);
      sum += static_cast<double>(length);
    }
  }
  EXPECT_NEAR(sum / (3.0 * static_cast<double>(mesh.triangles.size())), 0.2, 0.04);
  for (const auto& p : mesh.positions) EXPECT_NEAR(p.norm(), 1, 1e-3);
}

TEST(Remesh, KeepsTheHoleOfARing) {
  const DistanceGrid grid = grid_of(torus, 0.08F);
  const core::Mesh start = march_tetrahedra(grid);
  const TriangleTree tree(start);
  const core::Mesh mesh =
      remesh(start, 0.16F, 4, [&](const Eigen::Vector3f& p) { return tree.closest(p).point; });
  EXPECT_TRUE(is_closed_manifold(mesh));
  EXPECT_EQ(euler_number(mesh), 0);
}

TEST(EdgeMesh, RefusesWhatIsNotClosed) {
  core::Mesh mesh = march_tetrahedra(grid_of(ball, 0.4F));
  mesh.triangles.pop_back();
  EXPECT_FALSE(is_closed_manifold(mesh));
  EXPECT_THROW(EdgeMesh{mesh}, std::invalid_argument);
}

TEST(SelfIntersection, IsFoundWhereTwoBallsCross) {
  const core::Mesh one = march_tetrahedra(grid_of(ball, 0.4F));
  core::Mesh both = one;
  const auto first = static_cast<std::uint32_t>(one.positions.size());
  for (const auto& p : one.positions) both.positions.push_back(p + Eigen::Vector3f(0.5F, 0.1F, 0));
  for (const auto& t : one.triangles) both.triangles.emplace_back(t.array() + first);
  EXPECT_TRUE(is_closed_manifold(both));
  const auto pairs = find_self_intersections(both, 1);
  EXPECT_FALSE(pairs.empty());
  EXPECT_EQ(pairs, find_self_intersections(both, 3));
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, one.triangles.size());
    EXPECT_GE(b, one.triangles.size());
  }
}

// Some vertices of a ball are pushed by several edges: its triangles cross. They are parted,
// the ball is still one, and what crosses nowhere stays to the bit.
TEST(Untangle, PartsTrianglesThatCrossAndLeavesOthers) {
  const core::Mesh start = march_tetrahedra(grid_of(ball, 0.2F));
  const TriangleTree tree(start);
  const core::Mesh round =
      remesh(start, 0.16F, 4, [&](const Eigen::Vector3f& p) { return tree.closest(p).point; });
  core::Mesh same = round;
  EXPECT_TRUE(untangle(same, 1));
  EXPECT_EQ(same.positions, round.positions);
  EXPECT_EQ(same.normals, round.normals);

  core::Mesh crossed = round;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> push(-0.6F, 0.6F);
  for (std::size_t i = 0; i < crossed.positions.size(); i += 10) {
    crossed.positions[i] += Eigen::Vector3f(push(random), push(random), push(random));
  }
  ASSERT_FALSE(find_self_intersections(crossed, 1).empty());
  core::Mesh parted = crossed;
  ASSERT_TRUE(untangle(parted, 1));
  EXPECT_TRUE(find_self_intersections(parted, 1).empty());
  EXPECT_TRUE(is_closed_manifold(parted));
  EXPECT_NEAR(volume_of(parted), volume_of(round), 0.05 * volume_of(round));
  ASSERT_TRUE(untangle(crossed, 3));
  EXPECT_EQ(crossed.positions, parted.positions);
}

TEST(TriangleTree, AgreesWithAskingEveryTriangle) {
  const core::Mesh mesh = march_tetrahedra(grid_of(torus, 0.3F));
  const TriangleTree tree(mesh);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-1.6F, 1.6F);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3f p(place(random), place(random), place(random));
    float nearest = 1e9F;
    for (const auto& t : mesh.triangles) {
      nearest = std::min(nearest, closest_on_triangle(p, mesh.positions[t[0]], mesh.positions[t[1]],
                                                      mesh.positions[t[2]])
                                      .distance);
    }
    EXPECT_FLOAT_EQ(tree.closest(p).distance, nearest);
  }
}

TEST(NormalFilter, FlattensFacesAndKeepsEdgesSharp) {
  const core::Mesh start = march_tetrahedra(grid_of(cube, 0.1F));
  const TriangleTree tree(start);
  core::Mesh mesh =
      remesh(start, 0.15F, 3, [&](const Eigen::Vector3f& p) { return tree.closest(p).point; });
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.004F);
  for (auto& p : mesh.positions) p += Eigen::Vector3f(noise(random), noise(random), noise(random));
  const auto normals = filtered_normals(mesh, {.rounds = 10, .turn = 0.35F}, 1);
  // Two triangles away from the edges nearly every normal is that of its face; .1 is six degrees.
  double wrong = 0;
  double area = 0;
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const auto& t = mesh.triangles[f];
    const Eigen::Vector3f middle =
        (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    Eigen::Vector3f sorted = middle.cwiseAbs();
    std::sort(sorted.begin(), sorted.end());
    if (sorted[1] > 0.7F) continue;
    const double own = static_cast<double>((mesh.positions[t[1]] - mesh.positions[t[0]])
                                               .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                                               .norm());
    area += own;
    Eigen::Index axis = 0;
    middle.cwiseAbs().maxCoeff(&axis);
    if (std::abs(normals[f][axis]) < 0.995F) wrong += own;
  }
  EXPECT_LT(wrong / area, 0.05);
  EXPECT_EQ(normals, filtered_normals(mesh, {.rounds = 10, .turn = 0.35F}, 3));
}

}  // namespace
}  // namespace sheen::reconstruction
