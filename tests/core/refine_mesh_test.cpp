// SPDX-License-Identifier: MIT
#include "core/mesh/refine_mesh.h"

#include "core/mesh/repair.h"
#include "tests/core/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

namespace sheen::core {
namespace {

constexpr std::size_t kPlenty = 1'000'000;
using Place = std::array<float, 3>;

Place place_of(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

/// Cube of side 1, eight welded vertices. Every coordinate halves without rounding.
Mesh welded_cube() {
  Mesh cube;
  for (int i = 0; i < 8; ++i) {
    cube.positions.emplace_back(static_cast<float>(i & 1), static_cast<float>((i >> 1) & 1),
                                static_cast<float>(i >> 2));
  }
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  complete_normals(cube);
  return cube;
}

/// The same cube with hard edges: three own vertices and a flat normal per triangle.
Mesh cube_of_lone_faces() {
  const Mesh welded = welded_cube();
  Mesh cube;
  for (const auto& triangle : welded.triangles) {
    const auto first = static_cast<std::uint32_t>(cube.positions.size());
    const auto& p = welded.positions;
    const Eigen::Vector3f normal =
        (p[triangle[1]] - p[triangle[0]]).cross(p[triangle[2]] - p[triangle[0]]).normalized();
    for (const std::uint32_t corner : triangle) {
      cube.positions.push_back(p[corner]);
      cube.normals.push_back(normal);
    }
    cube.triangles.emplace_back(first, first + 1, first + 2);
  }
  return cube;
}

Eigen::Vector3d doubled_area(const Mesh& mesh, const Eigen::Matrix<std::uint32_t, 3, 1>& t) {
  const Eigen::Vector3d a = mesh.positions[t[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[t[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[t[2]].cast<double>();
  return (b - a).cross(c - a);
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) sum += 0.5 * doubled_area(mesh, t).norm();
  return sum;
}

/// Divergence theorem; positive for counter-clockwise from outside.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    sum += mesh.positions[t[0]].cast<double>().dot(doubled_area(mesh, t)) / 6;
  }
  return sum;
}

float longest_edge(const Mesh& mesh) {
  float longest = 0;
  for (const auto& t : mesh.triangles) {
    for (int side = 0; side < 3; ++side) {
      longest =
          std::max(longest, (mesh.positions[t[side]] - mesh.positions[t[(side + 1) % 3]]).norm());
    }
  }
  return longest;
}

/// Whether every edge, told by the places of its ends, runs once in either direction.
bool is_closed(const Mesh& mesh) {
  std::map<std::pair<Place, Place>, int> runs;
  for (const auto& t : mesh.triangles) {
    for (int side = 0; side < 3; ++side) {
      ++runs[{place_of(mesh.positions[t[side]]), place_of(mesh.positions[t[(side + 1) % 3]])}];
    }
  }
  return std::all_of(runs.begin(), runs.end(), [&](const auto& run) {
    const auto back = runs.find({run.first.second, run.first.first});
    return run.second == 1 && back != runs.end() && back->second == 1;
  });
}

TEST(RefineMesh, LeavesNoEdgeLongerThanTheLimit) {
  for (const float limit : {1.5f, 1.0f, 0.7f, 0.3f, 0.11f}) {
    EXPECT_LE(longest_edge(refine_mesh(welded_cube(), limit, kPlenty)), limit);
    EXPECT_LE(longest_edge(refine_mesh(testing::sphere(7, 9), limit, kPlenty)), limit);
  }
  // A needle 100 times as long as its foot.
  Mesh needle;
  needle.positions = {{0, 0, 0}, {0.01f, 0, 0}, {0, 1, 0}};
  needle.normals.assign(3, {0, 0, 1});
  needle.triangles = {{0, 1, 2}};
  EXPECT_LE(longest_edge(refine_mesh(needle, 0.02f, kPlenty)), 0.02f);
}

TEST(RefineMesh, KeepsAreaVolumeAndClosure) {
  for (const float limit : {1.2f, 0.6f, 0.2f}) {
    for (const Mesh& cube : {welded_cube(), cube_of_lone_faces()}) {
      const Mesh refined = refine_mesh(cube, limit, kPlenty);
      ASSERT_GT(refined.triangles.size(), cube.triangles.size());
      // Areas of faces and sixth parts of volumes are sums of dyadic numbers: exact, but for the
      // division by 6 of each term.
      EXPECT_EQ(area(refined), 6.0);
      EXPECT_NEAR(volume(refined), 1.0, 1e-12);
      EXPECT_TRUE(is_closed(refined));
    }
  }
}

TEST(RefineMesh, KeepsASphereClosedAndItsChordsFlat) {
  const Mesh sphere = testing::sphere(9, 14);
  const Mesh refined = refine_mesh(sphere, 0.1f, kPlenty);
  EXPECT_TRUE(is_closed(refined));
  // Midpoints round to the next float: relative 6e-8 each, over a handful of rounds.
  EXPECT_NEAR(area(refined), area(sphere), 1e-5);
  EXPECT_NEAR(volume(refined), volume(sphere), 1e-5);
}

TEST(RefineMesh, TurnsNoTriangleOver) {
  const Mesh refined = refine_mesh(cube_of_lone_faces(), 0.3f, kPlenty);
  for (const auto& t : refined.triangles) {
    // All three vertices carry the face's normal, which is the triangle's own.
    const Eigen::Vector3d normal = doubled_area(refined, t).normalized();
    for (const std::uint32_t corner : t) {
      EXPECT_EQ(normal, refined.normals[corner].cast<double>());
    }
  }
}

TEST(RefineMesh, HardEdgesStayHardWithEqualPlacesOnBothSides) {
  const Mesh refined = refine_mesh(cube_of_lone_faces(), 0.3f, kPlenty);
  std::map<Place, std::set<Place>> normals_at;
  for (std::size_t i = 0; i < refined.positions.size(); ++i) {
    normals_at[place_of(refined.positions[i])].insert(place_of(refined.normals[i]));
  }
  for (const auto& [place, normals] : normals_at) {
    // One normal per face the place lies on.
    const auto faces =
        std::count_if(place.begin(), place.end(), [](float x) { return x == 0.0f || x == 1.0f; });
    EXPECT_EQ(static_cast<std::ptrdiff_t>(normals.size()), faces);
  }
}

TEST(RefineMesh, OldVerticesKeepTheirPlacesAndNewNormalsAreUnit) {
  Mesh sphere = testing::sphere(6, 8);
  sphere.positions.emplace_back(5.0f, 5.0f, 5.0f);  // no triangle uses it
  sphere.normals.emplace_back(0.0f, 0.0f, 1.0f);
  const Mesh refined = refine_mesh(sphere, 0.2f, kPlenty);
  ASSERT_EQ(refined.positions.size(), refined.normals.size());
  for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
    EXPECT_EQ(refined.positions[i], sphere.positions[i]);
    EXPECT_EQ(refined.normals[i], sphere.normals[i]);
  }
  for (std::size_t i = sphere.positions.size(); i < refined.positions.size(); ++i) {
    EXPECT_NEAR(refined.normals[i].norm(), 1, 1e-6);
    // On a unit sphere the interpolated normal is the direction of the place itself, near enough:
    // edges of 60 degrees bend at most a few degrees off.
    EXPECT_GT(refined.normals[i].dot(refined.positions[i].normalized()), 0.99f);
  }
}

TEST(RefineMesh, OppositeNormalsGiveOneOfThem) {
  Mesh strip;
  strip.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0.1f, 0}};
  strip.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}};
  strip.triangles = {{0, 1, 2}};
  const Mesh refined = refine_mesh(strip, 0.9f, kPlenty);
  ASSERT_EQ(refined.positions.size(), 4u);
  EXPECT_EQ(refined.normals[3], Eigen::Vector3f(0, 0, 1));
}

TEST(RefineMesh, LeavesAloneWhatIsFineAlready) {
  // A grid of 0.1 m cells (diagonals 0.1414) beside one of 1 m cells.
  const Mesh fine = testing::square_grid(4, 0.2f, 0.0f);
  const Mesh refined =
      refine_mesh(testing::together(fine, testing::square_grid(2, 1.0f, 3.0f)), 0.15f, kPlenty);
  EXPECT_TRUE(std::equal(fine.triangles.begin(), fine.triangles.end(), refined.triangles.begin()));
  const auto at_floor = std::count_if(refined.positions.begin(), refined.positions.end(),
                                      [](const auto& p) { return p.z() == 0.0f; });
  EXPECT_EQ(at_floor, 25);
  EXPECT_LE(longest_edge(refined), 0.15f);
  // Nothing to do at all: the mesh itself.
  EXPECT_EQ(refine_mesh(fine, 0.15f, kPlenty).triangles, fine.triangles);
}

TEST(RefineMesh, StopsAtTheVertexLimitWithTheLongestEdgesHalved) {
  const Mesh sphere = testing::sphere(8, 10);
  std::size_t before = sphere.positions.size();
  for (const std::size_t most : {before - 1, before, before + 1, before + 100, before + 1000}) {
    const Mesh refined = refine_mesh(sphere, 0.01f, most);
    EXPECT_LE(refined.positions.size(), std::max(most, sphere.positions.size()));
    EXPECT_GE(refined.positions.size(), before);
    EXPECT_TRUE(is_closed(refined));
    before = refined.positions.size();
  }
  // Cut short within a round: hard edges are split on both sides or on none.
  const Mesh cube = cube_of_lone_faces();
  for (std::size_t most = cube.positions.size(); most < cube.positions.size() + 200; most += 7) {
    EXPECT_TRUE(is_closed(refine_mesh(cube, 0.01f, most)));
  }
  // The six face diagonals (sqrt 2, two copies each) go before the sides (1): 36 + 12 vertices.
  EXPECT_EQ(refine_mesh(cube, 0.01f, 36 + 12).positions.size(), 48u);
  EXPECT_EQ(longest_edge(refine_mesh(cube, 0.01f, 36 + 12)), 1.0f);
  EXPECT_EQ(refine_mesh(cube, 0.01f, 36 + 11).positions.size(), 36u);
}

}  // namespace
}  // namespace sheen::core
