// SPDX-License-Identifier: MIT
#include "core/geometry/lens/lens.h"

#include "core/alignment/projection_derivative.h"
#include "core/geometry/camera.h"
#include "core/samples/sampling_kernels.h"
#include "core/samples/vertex_view.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <cmath>
#include <random>

namespace sheen::core {
namespace {

CameraModel camera_with(LensKind lens, std::array<double, 8> k) {
  return CameraModel({1280, 960, {410, 405}, {650, 470}, k, lens});
}

const std::array kCameras{
    camera_with(LensKind::rational, {-0.3, 0.1, 2e-3, -1e-3, 0, 0, 0, 0}),
    camera_with(LensKind::rational, {0.2, -0.1, 1e-3, 5e-4, 0.02, 0.15, -0.05, 0.01}),
    camera_with(LensKind::fisheye, {}),
    camera_with(LensKind::fisheye, {-0.02, 0.006, -0.003, 0.0004, 0, 0, 0, 0})};

/// Rays over the part of the lens that is modelled, up to so many degrees from the axis.
template <typename Use>
void for_rays(const CameraModel& camera, double widest_deg, const Use& use) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const double widest_rad = std::min(widest_deg * M_PI / 180, std::atan(camera.valid_radius()));
  for (int i = 0; i < 500; ++i) {
    const double angle = 0.99 * widest_rad * unit(random);
    const double turn = 2 * M_PI * unit(random);
    use(Eigen::Vector2d(std::tan(angle) * std::cos(turn), std::tan(angle) * std::sin(turn)));
  }
}

TEST(Lens, FisheyeIsOpenCVsFisheye) {
  const std::array<double, 4> k{-0.02, 0.006, -0.003, 0.0004};
  const CameraModel camera = camera_with(LensKind::fisheye, {k[0], k[1], k[2], k[3], 0, 0, 0, 0});
  std::vector<cv::Point3d> points;
  std::vector<Eigen::Vector2d> ours;
  for_rays(camera, 85, [&](const Eigen::Vector2d& ideal) {
    points.emplace_back(ideal.x(), ideal.y(), 1);
    ours.push_back(*camera.project({ideal.x(), ideal.y(), 1}));
  });
  std::vector<cv::Point2d> theirs;
  cv::fisheye::projectPoints(points, theirs, cv::Vec3d(), cv::Vec3d(),
                             cv::Matx33d(410, 0, 650, 0, 405, 470, 0, 0, 1), k);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(ours[i].x(), theirs[i].x, 1e-9);
    EXPECT_NEAR(ours[i].y(), theirs[i].y, 1e-9);
  }
}

TEST(Lens, UndistortIsTheInverse) {
  for (const CameraModel& camera : kCameras) {
    for_rays(camera, 85, [&](const Eigen::Vector2d& ideal) {
      const auto back = camera.undistort(camera.distort(ideal));
      ASSERT_TRUE(back) << ideal.transpose();
      // Newton ends below 1e-12 of the image plane; far out a step there is a long one of the ray.
      EXPECT_LT((*back - ideal).norm(), 1e-9 * (1 + ideal.squaredNorm())) << ideal.transpose();
    });
  }
}

TEST(Lens, DerivativeIsThatOfTheProjection) {
  for (const CameraModel& camera : kCameras) {
    for_rays(camera, 75, [&](const Eigen::Vector2d& ideal) {
      const Eigen::Vector3d point = 0.7 * ideal.homogeneous();
      const auto projected = project_with_derivative(camera, point);
      ASSERT_TRUE(projected);
      EXPECT_EQ(projected->pixel, *camera.project(point));
      // Central differences of h: error h^2 / 6 times the third derivative, some 1e3 px/m^3 here.
      constexpr double h = 1e-6;
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector2d slope =
            (*camera.project(point + step) - *camera.project(point - step)) / (2 * h);
        EXPECT_LT((projected->pixel_by_point.col(axis) - slope).norm(), 1e-6 * (1 + slope.norm()));
      }
    });
  }
}

/// The inner loops of sampling have the same lenses in single precision.
TEST(Lens, SamplingLoopsProjectLikeTheCamera) {
  for (const CameraModel& camera : kCameras) {
    Mesh mesh;
    for_rays(camera, 80, [&](const Eigen::Vector2d& ideal) {
      mesh.positions.emplace_back((0.5 * ideal.homogeneous().normalized()).cast<float>());
      mesh.normals.emplace_back(-Eigen::Vector3f::UnitZ());
    });
    for (std::uint32_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
      mesh.triangles.emplace_back(i, i + 1, i + 2);
    }
    VertexView view;
    project_vertices(surface_points(mesh), camera, Eigen::Isometry3d::Identity(), {}, 1, view);
    for (std::size_t i = 0; i < mesh.positions.size() / 3 * 3; ++i) {
      const auto pixel = camera.project(mesh.positions[i].cast<double>());
      ASSERT_TRUE(pixel);
      // Six digits of a single-precision ray, times a focal length of 410 px and the arc tangent.
      EXPECT_NEAR(static_cast<double>(view.x_px[i]), pixel->x(), 2e-3);
      EXPECT_NEAR(static_cast<double>(view.y_px[i]), pixel->y(), 2e-3);
    }
  }
}

TEST(Lens, FisheyeSeesWhatAPinholeCannot) {
  // 80 degrees from the axis: r = 1.396 rad in the image plane, where a pinhole has tan = 5.67.
  const CameraModel camera = camera_with(LensKind::fisheye, {});
  const double angle = 80 * M_PI / 180;
  const auto pixel = camera.project({std::sin(angle), 0, std::cos(angle)});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 650 + 410 * angle, 1e-9);
  EXPECT_FALSE(camera.project({1, 0, -0.1}));
}

TEST(Lens, EveryKindHasItsFile) {
  for (const LensTraits& traits : kLenses) {
    EXPECT_EQ(&traits_of(traits.kind), &traits);
    const std::string name(traits.name);
    EXPECT_NE(lens_text(name + ".lens").find("void distort_" + name), std::string_view::npos);
  }
}

}  // namespace
}  // namespace sheen::core
