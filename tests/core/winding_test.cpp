// SPDX-License-Identifier: MIT
#include "core/mesh/winding.h"

#include "core/mesh/read_mesh.h"
#include "core/mesh/repair.h"
#include "tests/core/shapes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::core {
namespace {

/// The upper half of the unit sphere: open below.
Mesh bowl() {
  Mesh mesh = testing::sphere(16, 24);
  std::erase_if(mesh.triangles, [&mesh](const auto& triangle) {
    return std::min({mesh.positions[triangle[0]].z(), mesh.positions[triangle[1]].z(),
                     mesh.positions[triangle[2]].z()}) < -0.01f;
  });
  return mesh;
}

void turn_winding(Mesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

void turn_normals(Mesh& mesh) {
  for (auto& normal : mesh.normals) normal = -normal;
}

/// Cameras on a circle around the z axis, 5 from the origin, at the given height, looking at it.
std::vector<MeshView> ring_of_cameras(const CameraModel& camera, double height) {
  std::vector<MeshView> views;
  for (int i = 0; i < 8; ++i) {
    const double angle = 2 * std::numbers::pi * i / 8;
    const Eigen::Vector3d eye(5 * std::cos(angle), 5 * std::sin(angle), height);
    const Eigen::Vector3d z = -eye.normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Isometry3d mesh_from_camera = Eigen::Isometry3d::Identity();
    mesh_from_camera.linear() << x, z.cross(x), z;
    mesh_from_camera.translation() = eye;
    views.push_back({&camera, mesh_from_camera.inverse()});
  }
  return views;
}

const CameraModel kWitness(
    {.width_px = 320, .height_px = 240, .focal_px = {300, 300}, .principal_px = {159.5, 119.5}});

/// Triangles up to the corner they begin with.
std::vector<std::array<std::uint32_t, 3>> turned_free(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> all;
  for (const auto& t : mesh.triangles) {
    std::array<std::uint32_t, 3> triangle{t[0], t[1], t[2]};
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    all.push_back(triangle);
  }
  return all;
}

/// Normals by corner of the triangles: a vertex that no triangle uses has no side.
std::vector<Eigen::Vector3f> used_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  for (const auto& triangle : turned_free(mesh)) {
    for (const std::uint32_t corner : triangle) normals.push_back(mesh.normals[corner]);
  }
  return normals;
}

TEST(FaceCameras, OpenSurfacesTurnTheSideOutThatCamerasSee) {
  const Mesh right = bowl();
  const auto views = ring_of_cameras(kWitness, 3);
  for (const bool winding : {false, true}) {
    for (const bool normals : {false, true}) {
      SCOPED_TRACE((winding ? "winding " : "") + std::string(normals ? "normals" : ""));
      Mesh mesh = right;
      if (winding) turn_winding(mesh);
      if (normals) turn_normals(mesh);
      const SeenSides seen = face_cameras(mesh, views);
      EXPECT_EQ(turned_free(mesh), turned_free(right));
      EXPECT_EQ(seen.turned_parts, winding ? 1u : 0u);
      EXPECT_NEAR(seen.back_share, winding ? 1 : 0, 0.1);
      EXPECT_EQ(used_normals(mesh), used_normals(right));
    }
  }
}

TEST(FaceCameras, ABowlSeenFromAboveIsSeenFromInside) {
  // The lower half, looked into from above: its inside is the outside of what was scanned.
  Mesh mesh = bowl();
  for (auto& position : mesh.positions) position.z() = -position.z();
  mesh.normals.clear();
  complete_normals(mesh);
  const Mesh before = mesh;
  const auto views = ring_of_cameras(kWitness, 20);
  const SeenSides seen = face_cameras(mesh, views);
  // Mirrored triangles already run the way that shows them from inside.
  EXPECT_LT(seen.back_share, 0.1);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(FaceCameras, PartsAreJudgedOneByOne) {
  // Two bowls side by side, one inside out.
  Mesh left = bowl();
  Mesh right = bowl();
  for (auto& position : left.positions) position.x() -= 1.1f;
  for (auto& position : right.positions) position.x() += 1.1f;
  const Mesh good = testing::together(left, right);
  turn_winding(right);
  turn_normals(right);
  Mesh mesh = testing::together(left, right);
  const SeenSides seen = face_cameras(mesh, ring_of_cameras(kWitness, 3));
  EXPECT_EQ(seen.turned_parts, 1u);
  EXPECT_EQ(turned_free(mesh), turned_free(good));
  EXPECT_EQ(used_normals(mesh), used_normals(good));
}

TEST(FaceCameras, WithoutAViewNothingIsTurned) {
  Mesh mesh = bowl();
  turn_winding(mesh);
  const Mesh before = mesh;
  EXPECT_EQ(face_cameras(mesh, {}).rays, 0u);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(UnifyWinding, TurnsTheFewTriangles) {
  const Mesh right = bowl();
  Mesh mesh = right;
  std::size_t turned = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 5, ++turned) {
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  EXPECT_EQ(unify_winding(mesh), turned);
  EXPECT_EQ(turned_free(mesh), turned_free(right));
  EXPECT_EQ(unify_winding(mesh), 0u);
}

TEST(UnifyWinding, LeavesOneSidedSurfaces) {
  // A Moebius strip: no choice of directions agrees along every edge.
  Mesh strip;
  constexpr std::uint32_t n = 24;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(angle / 2);
      strip.positions.emplace_back(static_cast<float>(r * std::cos(angle)),
                                   static_cast<float>(r * std::sin(angle)),
                                   static_cast<float>(side * std::sin(angle / 2)));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    // The last piece joins the first turned over.
    const std::uint32_t c = i + 1 == n ? 1 : 2 * i + 2, d = i + 1 == n ? 0 : 2 * i + 3;
    strip.triangles.emplace_back(a, c, b);
    strip.triangles.emplace_back(b, c, d);
  }
  const Mesh before = strip;
  EXPECT_EQ(unify_winding(strip), 0u);
  EXPECT_EQ(strip.triangles, before.triangles);
}

TEST(ReadMesh, NormalsThatContradictTheWindingAreSaid) {
  const tests::TemporaryFolder folder;
  // Of a closed surface, whose outside is known: turned, with a note.
  Mesh ball = testing::sphere(12, 16);
  turn_normals(ball);
  write_ply(folder / "ball.ply", ball);
  std::vector<std::string> notes;
  const Mesh mesh = read_mesh(folder / "ball.ply", &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("turned"), std::string::npos) << notes[0];
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    EXPECT_GT(mesh.normals[i].dot(mesh.positions[i]), 0.99f);
  }
  // A part of them only: nobody knows which are right.
  for (std::size_t i = 0; i < ball.normals.size() / 2; ++i) ball.normals[i] = -ball.normals[i];
  write_ply(folder / "half.ply", ball);
  static_cast<void>(read_mesh(folder / "half.ply", &notes));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("contradict"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace sheen::core
