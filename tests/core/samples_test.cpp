// SPDX-License-Identifier: MIT
#include "core/samples/back_projection.h"
#include "core/samples/vertex_view.h"
#include "tests/core/shapes.h"

#include <gtest/gtest.h>

#include <random>

namespace sheen::core {
namespace {

using testing::camera_above;
/// Looks down the z axis from (0, 0, height).
const CameraModel kSmallCamera({101, 81, {100, 100}, {50, 40}, {}});

VertexRejection verdict(const Eigen::Vector3f& position, const Eigen::Vector3f& normal) {
  Mesh mesh;
  mesh.positions.assign(3, position);
  mesh.normals.assign(3, normal.normalized());
  mesh.triangles = {{0, 1, 2}};
  VertexView view;
  project_vertices(surface_points(mesh), kSmallCamera, camera_above(1.0), {}, 1, view);
  return view.rejection[0];
}

TEST(VertexView, EyeIsWhereThePoseIsUndone) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.5);
  EXPECT_LT((pose * eye_in_object(pose).cast<double>()).norm(), 1e-7);
}

TEST(VertexView, NamesTheFirstLimitThatFails) {
  const Eigen::Vector3f up(0, 0, 1);
  EXPECT_EQ(verdict({0, 0, 0}, up), VertexRejection::none);
  // Behind the camera wins over everything else.
  EXPECT_EQ(verdict({0, 0, 2}, -up), VertexRejection::outside_image);
  EXPECT_EQ(verdict({0, 0, 0}, -up), VertexRejection::back_facing);
  // Outside wins over back-facing.
  EXPECT_EQ(verdict({0.6f, 0, 0}, -up), VertexRejection::outside_image);
  // Cosine 0.19 against 0.2, and 0.21.
  EXPECT_EQ(verdict({0, 0, 0}, {std::sqrt(1 - 0.19f * 0.19f), 0, 0.19f}), VertexRejection::grazing);
  EXPECT_EQ(verdict({0, 0, 0}, {std::sqrt(1 - 0.21f * 0.21f), 0, 0.21f}), VertexRejection::none);
  // Pixel x = 50 + 100 x; the last that keeps two pixels to column 100 is 98, to column 0 is 2.
  EXPECT_EQ(verdict({0.479f, 0, 0}, up), VertexRejection::none);
  EXPECT_EQ(verdict({0.481f, 0, 0}, up), VertexRejection::outside_image);
  EXPECT_EQ(verdict({-0.479f, 0, 0}, up), VertexRejection::none);
  EXPECT_EQ(verdict({-0.481f, 0, 0}, up), VertexRejection::outside_image);
  // Pixel y = 40 - 100 y, rows 2 to 78.
  EXPECT_EQ(verdict({0, 0.379f, 0}, up), VertexRejection::none);
  EXPECT_EQ(verdict({0, 0.381f, 0}, up), VertexRejection::outside_image);
}

TEST(VertexView, VerticesWithoutTrianglesNeverBecomeSamples) {
  Mesh mesh = testing::square_grid(4, 0.2f, 0.0f);
  mesh.positions.emplace_back(0.0f, 0.0f, 0.0f);
  mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
  VertexView view;
  project_vertices(surface_points(mesh), kSmallCamera, camera_above(1.0), {}, 1, view);
  EXPECT_EQ(view.rejection.back(), VertexRejection::back_facing);
  EXPECT_EQ(count_rejections(view)[static_cast<std::size_t>(VertexRejection::none)], 25u);
}

TEST(VertexView, ThreadsDoNotMatterAndStorageIsReused) {
  const Mesh mesh = testing::sphere(60, 60);
  const SurfacePoints points = surface_points(mesh);
  const CameraModel camera({640, 480, {500, 500}, {320, 240}, {-0.2, 0.05, 1e-3, 1e-3, 0.01}});
  VertexView expected;
  project_vertices(points, camera, camera_above(4.0), {}, 1, expected);
  VertexView view;
  project_vertices(points, camera, camera_above(4.0), {}, 1, view);
  const float* storage = view.x_px.data();
  for (int threads = 1; threads <= 8; ++threads) {
    project_vertices(points, camera, camera_above(4.0), {}, threads, view);
    EXPECT_EQ(view.rejection, expected.rejection);
    EXPECT_EQ(view.x_px, expected.x_px);
    EXPECT_EQ(view.y_px, expected.y_px);
    EXPECT_EQ(view.u, expected.u);
    EXPECT_EQ(view.v, expected.v);
    EXPECT_EQ(view.x_px.data(), storage);
  }
}

/// Channel values 2 x + 3 y + c in 50 x 40 pixels: at most 2 * 49 + 3 * 39 + 20 = 235.
cv::Mat ramp() {
  cv::Mat image(40, 50, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto value = static_cast<std::uint8_t>(2 * x + 3 * y);
      image.at<cv::Vec3b>(y, x) = {value, static_cast<std::uint8_t>(value + 10),
                                   static_cast<std::uint8_t>(value + 20)};
    }
  }
  return image;
}

VertexView random_view(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  VertexView view;
  for (std::size_t i = 0; i < count; ++i) {
    view.x_px.push_back(1 + 47 * unit(random));
    view.y_px.push_back(1 + 37 * unit(random));
    view.depth_m.push_back(1);
    view.u.push_back(unit(random));
    view.v.push_back(-unit(random));
    view.rejection.push_back(i % 3 == 1 ? VertexRejection::occluded : VertexRejection::none);
  }
  return view;
}

TEST(BackProjection, ReadsALinearImageExactly) {
  const VertexView view = random_view(300);
  SampleBatch batch;
  back_project(ramp(), view, batch);
  ASSERT_EQ(batch.size(), 200u);
  for (std::size_t s = 0; s < batch.size(); ++s) {
    const std::size_t i = batch.patch[s];
    // Patches ascend and skip the rejected ones: 0 2 3 5 6 8 ...
    EXPECT_EQ(i, s + (s + 1) / 2);
    EXPECT_EQ(batch.u[s], view.u[i]);
    EXPECT_EQ(batch.v[s], view.v[i]);
    // Bilinear interpolation reproduces linear functions; blue is channel 0.
    const float blue = 2 * view.x_px[i] + 3 * view.y_px[i];
    EXPECT_NEAR(batch.b[s], blue / 255, 1e-6);
    EXPECT_NEAR(batch.g[s], (blue + 10) / 255, 1e-6);
    EXPECT_NEAR(batch.r[s], (blue + 20) / 255, 1e-6);
  }
}

TEST(BackProjection, AllocatesNothingTheSecondTime) {
  const cv::Mat image = ramp();
  SampleBatch batch;
  back_project(image, random_view(300), batch);
  const void* patch = batch.patch.data();
  const float* columns[] = {batch.u.data(), batch.v.data(), batch.r.data(), batch.g.data(),
                            batch.b.data()};
  back_project(image, random_view(30), batch);
  EXPECT_EQ(batch.size(), 20u);
  back_project(image, random_view(300), batch);
  EXPECT_EQ(batch.size(), 200u);
  EXPECT_EQ(batch.patch.data(), patch);
  EXPECT_EQ(batch.u.data(), columns[0]);
  EXPECT_EQ(batch.v.data(), columns[1]);
  EXPECT_EQ(batch.r.data(), columns[2]);
  EXPECT_EQ(batch.g.data(), columns[3]);
  EXPECT_EQ(batch.b.data(), columns[4]);
}

TEST(BackProjection, LeavesOutWhatTheImageDoesNotHold) {
  VertexView view = random_view(4);
  view.rejection.assign(4, VertexRejection::none);
  view.x_px = {-0.1f, 49.0f, 10.0f, 48.9f};
  view.y_px = {5.0f, 5.0f, 39.0f, 38.9f};
  SampleBatch batch;
  back_project(ramp(), view, batch);
  ASSERT_EQ(batch.size(), 1u);
  EXPECT_EQ(batch.patch[0], 3u);
}

}  // namespace
}  // namespace sheen::core
