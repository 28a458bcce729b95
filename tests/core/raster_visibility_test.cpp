// SPDX-License-Identifier: MIT
// The raster against rays from every vertex, and against what geometry says.
#include "core/visibility/raster_visibility.h"

#include "core/mesh/read_mesh.h"
#include "core/samples/sampling_kernels.h"
#include "core/visibility/ray_visibility.h"
#include "tests/core/shapes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace sheen::core {
namespace {

using testing::camera_above;
using testing::sphere;
using testing::square_grid;
using testing::together;

const CameraModel kPlain({1280, 720, {1100, 1100}, {640, 360}, {}});
/// Bends a line across the image by several per cent of its width.
const CameraModel kDistorted({1280, 720, {1100, 1090}, {655, 340}, {-0.3, 0.1, 2e-3, -1e-3, 0}});

/// Looks at the origin from a direction; the image's y axis points away from `up`.
Eigen::Isometry3d looking_from(const Eigen::Vector3d& side, double distance_m) {
  const Eigen::Vector3d forward = -side.normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d(0.1, 0.2, 1)).normalized();
  Eigen::Isometry3d camera_from_object = Eigen::Isometry3d::Identity();
  camera_from_object.linear().row(0) = right.transpose();
  camera_from_object.linear().row(1) = forward.cross(right).transpose();
  camera_from_object.linear().row(2) = forward.transpose();
  camera_from_object.translation() = Eigen::Vector3d(0, 0, distance_m);
  return camera_from_object;
}

const Eigen::Vector3d kSides[] = {{1, 0.1, 0.2}, {-0.4, 1, 0.7}, {0.3, -0.8, 1}, {-1, -0.5, -0.3}};

VertexView projected(const Mesh& mesh, const CameraModel& camera, const Eigen::Isometry3d& pose) {
  VertexView view;
  project_vertices(surface_points(mesh), camera, pose, {}, 1, view);
  return view;
}

std::size_t count_of(const VertexView& view, VertexRejection rejection) {
  return count_rejections(view)[static_cast<std::size_t>(rejection)];
}

struct Agreement {
  std::size_t candidates = 0;
  std::size_t hidden = 0;  ///< by rays
  std::size_t alike = 0;

  [[nodiscard]] double share(std::size_t count) const {
    return static_cast<double>(count) / static_cast<double>(candidates);
  }
};

/// Both on the same candidates, from a few sides.
Agreement compare(const Mesh& mesh, const CameraModel& camera, double distance_m) {
  const auto by_raster = make_raster_visibility(mesh, 1);
  const auto by_rays = make_ray_visibility(mesh, 1);
  Agreement result;
  for (const Eigen::Vector3d& side : kSides) {
    const Eigen::Isometry3d pose = looking_from(side, distance_m);
    const VertexView before = projected(mesh, camera, pose);
    VertexView raster_view = before;
    VertexView ray_view = before;
    by_raster->reject_occluded(camera, pose, raster_view);
    by_rays->reject_occluded(camera, pose, ray_view);
    for (std::size_t i = 0; i < before.rejection.size(); ++i) {
      if (before.rejection[i] != VertexRejection::none) {
        EXPECT_EQ(raster_view.rejection[i], before.rejection[i]);
        continue;
      }
      ++result.candidates;
      result.hidden += ray_view.rejection[i] == VertexRejection::occluded ? 1 : 0;
      result.alike += ray_view.rejection[i] == raster_view.rejection[i] ? 1 : 0;
    }
  }
  return result;
}

/// Spheres of radius 0.04 m in a row: each hides parts of the next from most sides.
Mesh row_of_spheres(int rings, float spacing_m) {
  Mesh row;
  for (int i = -2; i <= 2; ++i) {
    Mesh one = sphere(rings, 2 * rings);
    for (Eigen::Vector3f& position : one.positions) {
      position = 0.04f * position + Eigen::Vector3f(spacing_m * static_cast<float>(i), 0, 0);
    }
    row = together(row, one);
  }
  return row;
}

TEST(RasterVisibility, ConvexSurfaceHidesNothingOfItself) {
  for (const CameraModel& camera : {kPlain, kDistorted}) {
    for (const int rings : {8, 40, 125}) {
      const Agreement found = compare(sphere(rings, 2 * rings), camera, 4.5);
      EXPECT_EQ(found.hidden, 0u);
      EXPECT_EQ(found.alike, found.candidates) << rings << " rings";
    }
  }
}

TEST(RasterVisibility, AgreesWithRaysFromCoarseToFine) {
  for (const CameraModel& camera : {kPlain, kDistorted}) {
    for (const int rings : {6, 20, 60, 110}) {
      const Agreement found = compare(row_of_spheres(rings, 0.09f), camera, 0.4);
      EXPECT_GT(found.share(found.hidden), 0.05) << "nothing to find out";
      EXPECT_GE(found.share(found.alike), 0.999) << rings << " rings";
    }
  }
}

// Where surfaces cross, a vertex less than two pixels' slope below the other counts as seen.
TEST(RasterVisibility, AgreesWithRaysWhereSurfacesCross) {
  for (const CameraModel& camera : {kPlain, kDistorted}) {
    const Agreement found = compare(row_of_spheres(20, 0.07f), camera, 0.4);
    EXPECT_GE(found.share(found.alike), 0.995);
  }
}

TEST(RasterVisibility, AgreesWithRaysOnScannedMeshes) {
  for (const char* name : {"bunny.ply", "igea.ply", "spot.obj"}) {
    const auto path = std::filesystem::path(SHEEN_SHARED_DATA) / "meshes" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    Mesh mesh = read_mesh(path);
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
    for (Eigen::Vector3f& position : mesh.positions) {
      position = 0.2f / box.diagonal().norm() * (position - box.center());
    }
    for (const CameraModel& camera : {kPlain, kDistorted}) {
      const Agreement found = compare(mesh, camera, 0.45);
      RecordProperty(std::string(name), std::to_string(found.share(found.alike)));
      EXPECT_GE(found.share(found.alike), 0.995) << name;
    }
  }
}

/// A camera at (0, 0, height) that looks down the z axis.
// From z = 3 a square of half side 0.5 in z = 1 covers half side 0.5 * 3 / 2 = 0.75 of z = 0, to
// the vertex: what the pixels leave open the rays decide. Both with one square of two triangles,
// which is bent, and with small ones.
TEST(RasterVisibility, ParallelSquaresHideByTheRuleOfThree) {
  const CameraModel wide({1280, 720, {400, 400}, {640, 360}, {-0.1, 0, 0, 0, 0}});
  for (const int cells : {1, 64}) {
    const Mesh back = square_grid(150, 2.0f, 0.0f);
    const Mesh mesh = together(back, square_grid(cells, 0.5f, 1.0f));
    VertexView view = projected(mesh, wide, camera_above(3));
    make_raster_visibility(mesh, 1)->reject_occluded(wide, camera_above(3), view);
    for (std::size_t i = 0; i < back.positions.size(); ++i) {
      // 150 cells of 4/150 put no vertex on the shadow's border: 0.75 * 150 / 4 = 28.125 steps.
      const bool hidden = mesh.positions[i].head<2>().cwiseAbs().maxCoeff() < 0.75f;
      ASSERT_EQ(view.rejection[i] == VertexRejection::occluded, hidden)
          << mesh.positions[i].transpose();
    }
  }
}

TEST(RasterVisibility, FacesSeenFromBehindDoNotHide) {
  Mesh front = square_grid(64, 0.5f, 1.0f);
  for (auto& triangle : front.triangles) std::swap(triangle[1], triangle[2]);
  const Mesh mesh = together(square_grid(150, 1.0f, 0.0f), front);
  VertexView view = projected(mesh, kPlain, camera_above(3));
  make_raster_visibility(mesh, 1)->reject_occluded(kPlain, camera_above(3), view);
  EXPECT_EQ(count_of(view, VertexRejection::occluded), 0u);
}

// A lid of two triangles whose corners lie beside, behind and beyond what the camera sees: nothing
// under it is seen, though none of its corners has a pixel.
TEST(RasterVisibility, TrianglesAroundTheWholeImageHide) {
  Mesh lid = square_grid(1, 50.0f, 1.0f);
  const Mesh mesh = together(square_grid(150, 0.5f, 0.0f), lid);
  Eigen::Isometry3d pose = camera_above(2);
  pose.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()) * pose.linear();
  for (const CameraModel& camera : {kPlain, kDistorted}) {
    VertexView view = projected(mesh, camera, pose);
    ASSERT_GT(count_of(view, VertexRejection::none), 1000u);
    make_raster_visibility(mesh, 1)->reject_occluded(camera, pose, view);
    EXPECT_EQ(count_of(view, VertexRejection::none), 0u);
  }
}

TEST(RasterVisibility, NeitherThreadsNorInstructionSetsMatter) {
  const Mesh mesh = row_of_spheres(60, 0.09f);
  const Eigen::Isometry3d pose = looking_from(kSides[0], 0.4);
  const VertexView before = projected(mesh, kDistorted, pose);
  VertexView expected = before;
  make_raster_visibility(mesh, 1)->reject_occluded(kDistorted, pose, expected);
  EXPECT_GT(count_of(expected, VertexRejection::occluded), 100u);
  for (const RasterKernels& kernels : raster_kernel_sets()) {
    for (const int threads : {1, 2, 3, 8}) {
      VertexView view = before;
      make_raster_visibility(mesh, threads, kernels)->reject_occluded(kDistorted, pose, view);
      EXPECT_EQ(view.rejection, expected.rejection) << kernels.instruction_set << threads;
    }
  }
}

TEST(RasterVisibility, NothingToAskIsNoTrouble) {
  VertexView none;
  make_raster_visibility(Mesh{}, 2)->reject_occluded(kPlain, camera_above(1), none);
  EXPECT_TRUE(none.rejection.empty());
  // Everything behind the camera.
  const Mesh mesh = sphere(20, 40);
  VertexView view = projected(mesh, kPlain, camera_above(-5));
  make_raster_visibility(mesh, 2)->reject_occluded(kPlain, camera_above(-5), view);
  EXPECT_EQ(count_of(view, VertexRejection::outside_image), mesh.positions.size());
  // Triangles of one point, and of one line.
  Mesh flat = square_grid(20, 0.1f, 0.0f);
  flat.triangles.emplace_back(0u, 0u, 0u);
  flat.triangles.emplace_back(0u, 1u, 2u);
  VertexView flat_view = projected(flat, kPlain, camera_above(0.5));
  make_raster_visibility(flat, 2)->reject_occluded(kPlain, camera_above(0.5), flat_view);
  EXPECT_EQ(count_of(flat_view, VertexRejection::none), flat.positions.size());
}

TEST(SamplingKernels, ProjectAsTheCameraModelDoes) {
  const Mesh mesh = row_of_spheres(40, 0.09f);
  for (const Eigen::Vector3d& side : kSides) {
    const Eigen::Isometry3d pose = looking_from(side, 0.4);
    const VertexView view = projected(mesh, kDistorted, pose);
    const Eigen::Vector3f eye = eye_in_object(pose);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Eigen::Vector3d in_camera = pose * mesh.positions[i].cast<double>();
      const auto pixel = kDistorted.project(in_camera);
      ASSERT_TRUE(pixel);
      // Coordinates of 0.5 m at half an ulp (3e-8), three sums each, at f / z = 1100 / 0.25 pixels
      // per metre: 4e-4 px; the same again from the lens.
      EXPECT_NEAR(static_cast<double>(view.x_px[i]), pixel->x(), 1e-3);
      EXPECT_NEAR(static_cast<double>(view.y_px[i]), pixel->y(), 1e-3);
      EXPECT_NEAR(static_cast<double>(view.depth_m[i]), in_camera.z(), 1e-6);
      const DiscDirection direction =
          direction_towards(tangent_frame(mesh.normals[i]), mesh.positions[i], eye);
      EXPECT_NEAR(view.u[i], direction.uv.x(), 1e-6);
      EXPECT_NEAR(view.v[i], direction.uv.y(), 1e-6);
    }
  }
}

TEST(SamplingKernels, ProjectWithTheSameBitsOnEveryInstructionSet) {
  const SurfacePoints points = surface_points(sphere(31, 47));
  // Some behind the camera, some beyond the lens model, some outside the image.
  const ProjectionSetup setup{{0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f},
                              {0.1f, -0.2f, 0.7f},
                              {2.4f, 3.2f, 3.0f},
                              {300, 310},
                              {320, 240},
                              LensKind::rational,
                              {-0.3f, 0.1f, 2e-3f, -1e-3f, 0, 0, 0, 0},
                              1.5f,
                              2,
                              {637, 477},
                              0.2f};
  std::vector<VertexView> views;
  for (const SamplingKernels& kernels : sampling_kernel_sets()) {
    VertexView& view = views.emplace_back();
    for (auto* column : {&view.x_px, &view.y_px, &view.depth_m, &view.u, &view.v}) {
      column->resize(points.size());
    }
    view.rejection.resize(points.size());
    kernels.project(setup,
                    {points.x.data(), points.y.data(), points.z.data(), points.nx.data(),
                     points.ny.data(), points.nz.data(), view.x_px.data(), view.y_px.data(),
                     view.depth_m.data(), view.u.data(), view.v.data(), view.rejection.data()},
                    0, points.size());
    EXPECT_EQ(view.x_px, views.front().x_px) << kernels.instruction_set;
    EXPECT_EQ(view.y_px, views.front().y_px);
    EXPECT_EQ(view.depth_m, views.front().depth_m);
    EXPECT_EQ(view.u, views.front().u);
    EXPECT_EQ(view.v, views.front().v);
    EXPECT_EQ(view.rejection, views.front().rejection);
  }
  EXPECT_GT(count_of(views.front(), VertexRejection::none), 20u);
  EXPECT_GT(count_of(views.front(), VertexRejection::outside_image), 20u);
}

}  // namespace
}  // namespace sheen::core
