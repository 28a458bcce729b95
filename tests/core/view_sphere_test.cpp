// SPDX-License-Identifier: MIT
#include "core/directions/view_sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace sheen::core {
namespace {

std::vector<Eigen::Vector3d> random_directions(int count, double least_z, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> directions;
  while (static_cast<int>(directions.size()) < count) {
    const Eigen::Vector3d one(normal(random), normal(random), normal(random));
    if (one.normalized().z() >= least_z) directions.push_back(one.normalized());
  }
  return directions;
}

/// The direction that a blend stands for.
Eigen::Vector3d blended(const std::vector<Eigen::Vector3d>& directions, const SphereBlend& blend) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    sum += static_cast<double>(blend.weight[i]) * directions[blend.index[i]];
  }
  return sum.normalized();
}

void expect_convex(const SphereBlend& blend) {
  EXPECT_NEAR(blend.weight[0] + blend.weight[1] + blend.weight[2], 1.0f, 1e-6f);
  for (const float weight : blend.weight) EXPECT_GE(weight, 0.0f);
}

// A closed triangulation of n points has 2 n - 4 triangles (Euler), and holds every direction: the
// blend stands for the direction itself.
TEST(ViewSphere, CoversTheWholeSphere) {
  const auto directions = random_directions(300, -1);
  const ViewSphere sphere(directions);
  EXPECT_EQ(sphere.triangles().size(), 2 * directions.size() - 4);
  EXPECT_TRUE(sphere.borders().empty());
  for (const Eigen::Vector3d& one : random_directions(100, -1, 2)) {
    const SphereBlend blend = sphere.blend(one);
    expect_convex(blend);
    EXPECT_LT((blended(directions, blend) - one).norm(), 1e-5);
  }
}

// Delaunay: no direction lies within the circle of a triangle.
TEST(ViewSphere, CirclesOfTrianglesAreEmpty) {
  const auto directions = random_directions(60, -1);
  const ViewSphere sphere(directions);
  for (const auto& [a, b, c] : sphere.triangles()) {
    Eigen::Vector3d pole =
        (directions[b] - directions[a]).cross(directions[c] - directions[a]).normalized();
    if (pole.dot(directions[a]) < 0) pole = -pole;
    for (const Eigen::Vector3d& one : directions) {
      EXPECT_LE(one.dot(pole), directions[a].dot(pole) + 1e-9);
    }
  }
}

TEST(ViewSphere, IsExactAtItsDirections) {
  const auto directions = random_directions(80, 0.1);
  const ViewSphere sphere(directions);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const SphereBlend blend = sphere.blend(directions[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (blend.index[k] == i) continue;
      EXPECT_LT(blend.weight[k], 1e-5f);
    }
  }
}

// Outside of a cap a direction is moved to its rim: nothing is extrapolated, and nothing jumps
// where the rim is crossed.
TEST(ViewSphere, ClampsOutsideOfACap) {
  const auto directions = random_directions(200, 0.3);
  const ViewSphere sphere(directions);
  EXPECT_FALSE(sphere.borders().empty());
  for (int i = 0; i < 36; ++i) {
    const double azimuth = 10 * i * M_PI / 180;
    Eigen::Vector3d last = Eigen::Vector3d::UnitZ();
    for (double polar = 0.01; polar < 1.5; polar += 0.01) {
      const Eigen::Vector3d one(std::sin(polar) * std::cos(azimuth),
                                std::sin(polar) * std::sin(azimuth), std::cos(polar));
      const SphereBlend blend = sphere.blend(one);
      expect_convex(blend);
      const Eigen::Vector3d place = blended(directions, blend);
      EXPECT_GT(place.z(), 0.25);  // an arc between two directions of the cap stays in it
      EXPECT_LT((place - last).norm(), 0.1);
      last = place;
    }
  }
}

// A turntable at the height of the object: all directions lie in one plane with its centre.
TEST(ViewSphere, JoinsARing) {
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i < 12; ++i) {
    const double azimuth = 7 * i % 12 * M_PI / 6;
    ring.emplace_back(std::cos(azimuth), std::sin(azimuth), 0);
  }
  const ViewSphere sphere(ring);
  EXPECT_TRUE(sphere.triangles().empty());
  const Eigen::Vector3d between(std::cos(0.3), std::sin(0.3), 0);
  EXPECT_LT((blended(ring, sphere.blend(between)) - between).norm(), 1e-5);
  const Eigen::Vector3d above(std::cos(0.3) * std::sqrt(0.5), std::sin(0.3) * std::sqrt(0.5),
                              std::sqrt(0.5));
  EXPECT_LT((blended(ring, sphere.blend(above)) - between).norm(), 1e-5);
}

TEST(ViewSphere, TakesFewAndRepeatedDirections) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  for (const auto& few : {std::vector{x}, std::vector{x, x}, std::vector{x, y},
                          std::vector<Eigen::Vector3d>{x, -x}, std::vector{x, x, y, y, x},
                          std::vector<Eigen::Vector3d>{x, y, Eigen::Vector3d::UnitZ(), x}}) {
    const ViewSphere sphere(few);
    for (const Eigen::Vector3d& one : random_directions(20, -1)) {
      const SphereBlend blend = sphere.blend(one);
      expect_convex(blend);
      for (const std::uint32_t index : blend.index) EXPECT_LT(index, few.size());
    }
    EXPECT_LT((blended(few, sphere.blend(x)) - x).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace sheen::core
