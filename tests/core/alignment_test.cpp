// SPDX-License-Identifier: MIT
// Photometric alignment: a textured plane drawn by rays, posed wrongly and put right again.
#include "core/alignment/align_pose.h"
#include "core/alignment/exposure.h"
#include "core/alignment/projection_derivative.h"
#include "core/alignment/seamless_neighbours.h"
#include "core/alignment/select_points.h"
#include "core/visibility/ray_caster.h"
#include "tests/core/shapes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <cmath>
#include <numbers>
#include <random>

namespace sheen::core {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

CameraModel barrel_camera() {
  return CameraModel({.width_px = 320,
                      .height_px = 240,
                      .focal_px = {300, 302},
                      .principal_px = {160.2, 118.7},
                      .distortion = {-0.12, 0.05, 0.001, -0.0007, 0, 0, 0, 0}});
}

/// 0.4 m in front of a plane of 0.2 m, tilted against it.
Eigen::Isometry3d true_pose() {
  Eigen::Isometry3d camera_from_object = Eigen::Isometry3d::Identity();
  camera_from_object.linear() = (Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.6, 0.8, 0)))
                                    .toRotationMatrix();
  camera_from_object.translation() = Eigen::Vector3d(0.01, -0.005, 0.4);
  return camera_from_object;
}

/// Smooth waves of 12 to 25 mm, luma within [0.2, 0.8] as even 8-bit numbers may hold it.
double texture(double x_m, double y_m) {
  return 0.5 + 0.1 * std::sin(350 * x_m + 1) + 0.1 * std::sin(400 * y_m) +
         0.1 * std::sin(250 * (x_m + y_m)) * std::cos(300 * (x_m - y_m));
}

struct PlaneScene {
  Mesh mesh = testing::square_grid(60, 0.1f, 0.0f);
  CameraModel camera = barrel_camera();
  Eigen::Isometry3d camera_from_object = true_pose();
  double contrast = 1;

  [[nodiscard]] double luma(const Eigen::Vector3f& point) const {
    return 0.5 +
           contrast *
               (texture(static_cast<double>(point.x()), static_cast<double>(point.y())) - 0.5);
  }

  /// Image of the plane, a ray through every pixel's centre; grey of even numbers.
  [[nodiscard]] cv::Mat image() const {
    const RayCaster caster(mesh);
    const Eigen::Vector3f eye = eye_in_object(camera_from_object);
    cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC3, cv::Scalar::all(128));
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const auto ray = camera.unproject({x, y});
        if (!ray) continue;
        const Eigen::Vector3f direction =
            (camera_from_object.linear().transpose() * *ray).cast<float>();
        const auto hit = caster.first_hit(eye, direction, 0.0f, 10.0f);
        if (!hit) continue;
        const double value = luma(eye + hit->distance * direction);
        image.at<cv::Vec3b>(y, x) =
            cv::Vec3b::all(static_cast<uchar>(2 * std::lround(127 * value)));
      }
    }
    return image;
  }

  /// What a perfect model says of the vertices away from the rim, whose outline is no texture.
  [[nodiscard]] ExpectedPoints expected() const {
    ExpectedPoints points;
    for (const auto& position : mesh.positions) {
      if (position.cwiseAbs().maxCoeff() > 0.09f) continue;
      points.position.push_back(position);
      points.luma.push_back(static_cast<float>(luma(position)));
      points.weight.push_back(1.0f);
    }
    return points;
  }
};

GradientImage gradients_of(const cv::Mat& image) {
  GradientImage gradients;
  gradients.look_at(image, {0, 0, image.cols, image.rows}, 0.7);
  return gradients;
}

Eigen::Isometry3d perturbed(const Eigen::Isometry3d& pose, double degrees, double metres) {
  Eigen::Isometry3d twist = Eigen::Isometry3d::Identity();
  twist.linear() = Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d(1, -2, 2).normalized())
                       .toRotationMatrix();
  twist.translation() = metres * Eigen::Vector3d(2, 1, -2).normalized();
  return twist * pose;
}

/// Root mean square distance between the points' pixels from two poses.
double motion_px(const PlaneScene& scene, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  double sum = 0;
  for (const auto& position : scene.mesh.positions) {
    sum += (*scene.camera.project(a * position.cast<double>()) -
            *scene.camera.project(b * position.cast<double>()))
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(scene.mesh.positions.size()));
}

TEST(ProjectionDerivative, IsTheDifferenceQuotientOfProject) {
  // Central differences of a function with third derivatives below 1e5 px/m^3 and h = 1e-5 m are
  // off by less than h^2 / 6 * 1e5 ~ 2e-6 px/m, plus rounding 1e-13 / h = 1e-8.
  const CameraModel camera({.width_px = 640,
                            .height_px = 480,
                            .focal_px = {500, 510},
                            .principal_px = {320, 240},
                            .distortion = {-0.3, 0.1, 0.002, -0.003, 0.01, 0.02, -0.01, 0.003}});
  const Eigen::Vector3d point(0.12, -0.2, 0.6);
  const auto projected = project_with_derivative(camera, point);
  ASSERT_TRUE(projected);
  EXPECT_EQ(projected->pixel, *camera.project(point));
  constexpr double h = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector2d quotient =
        (*camera.project(point + step) - *camera.project(point - step)) / (2 * h);
    EXPECT_LT((projected->pixel_by_point.col(axis) - quotient).norm(), 1e-5) << "axis " << axis;
  }
}

TEST(ProjectionDerivative, HasNoValueBehindTheCamera) {
  EXPECT_FALSE(project_with_derivative(barrel_camera(), {0, 0, -1}));
}

TEST(AlignPose, RecoversASmallPerturbationToATenthOfIt) {
  const PlaneScene scene;
  const GradientImage image = gradients_of(scene.image());
  const Eigen::Isometry3d start = perturbed(scene.camera_from_object, 0.2, 0.0005);
  // The model is perfect: every residual speaks for itself, and the start may be 1 px off.
  const auto aligned =
      align_pose(scene.expected(), image, scene.camera, start, {.prior_px = 1, .share = 1});
  ASSERT_TRUE(aligned);
  const Eigen::Isometry3d error = aligned->camera_from_object * scene.camera_from_object.inverse();
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.1 * 0.2 * kDegree);
  EXPECT_LT(motion_px(scene, aligned->camera_from_object, scene.camera_from_object),
            0.1 * motion_px(scene, start, scene.camera_from_object));
  EXPECT_LT(aligned->rms_after, aligned->rms_before);
}

TEST(AlignPose, ComesNearOnACoarserImageFirst) {
  // 0.2 degrees and 0.5 mm are half a pixel here: three times that is beyond the first step's limit
  // of one.
  const PlaneScene scene;
  const Eigen::Isometry3d start = perturbed(scene.camera_from_object, 0.6, 0.0015);
  ASSERT_GT(motion_px(scene, start, scene.camera_from_object), 1.0);
  const auto aligned = align_pose(scene.expected(), gradients_of(scene.image()), scene.camera,
                                  start, {.prior_px = 1, .share = 1});
  ASSERT_TRUE(aligned);
  EXPECT_LT(motion_px(scene, aligned->camera_from_object, scene.camera_from_object), 0.2);
}

TEST(AlignPose, RefusesAMotionBeyondItsLimit) {
  const PlaneScene scene;
  const Eigen::Isometry3d start = perturbed(scene.camera_from_object, 0.2, 0.0005);
  EXPECT_FALSE(align_pose(scene.expected(), gradients_of(scene.image()), scene.camera, start,
                          {.prior_px = 1, .max_motion_px = 0.1}));
}

TEST(AlignPose, HasNoAnswerForASurfaceWithoutTexture) {
  PlaneScene scene;
  scene.contrast = 0;
  const Eigen::Isometry3d start = perturbed(scene.camera_from_object, 0.2, 0.0005);
  EXPECT_FALSE(align_pose(scene.expected(), gradients_of(scene.image()), scene.camera, start, {}));
}

TEST(AlignPose, HasNoAnswerForTooFewPointsOrAnObjectOutOfTheImage) {
  const PlaneScene scene;
  const GradientImage image = gradients_of(scene.image());
  EXPECT_FALSE(align_pose({}, image, scene.camera, scene.camera_from_object, {}));
  Eigen::Isometry3d behind = scene.camera_from_object;
  behind.translation().z() = -1;
  EXPECT_FALSE(align_pose(scene.expected(), image, scene.camera, behind, {}));
}

TEST(AlignPose, GainScalesWithTheImageAndThePoseDoesNot) {
  // Every pixel is even, so half the image is exact: luma, gradients and residuals halve, and
  // with the gain at half the minimum lies at the same pose. What differs is the floor of the
  // robust width (2 / 255 does not halve): below 0.02 px here.
  const PlaneScene scene;
  const cv::Mat bright = scene.image();
  const cv::Mat dark = bright / 2;
  const Eigen::Isometry3d start = perturbed(scene.camera_from_object, 0.2, 0.0005);
  const ExpectedPoints points = scene.expected();
  const auto whole = align_pose(points, gradients_of(bright), scene.camera, start, {.prior_px = 1});
  const auto half = align_pose(points, gradients_of(dark), scene.camera, start, {.prior_px = 1});
  ASSERT_TRUE(whole && half);
  EXPECT_NEAR(half->gain, whole->gain / 2, 1e-4);
  EXPECT_LT(motion_px(scene, whole->camera_from_object, half->camera_from_object), 0.02);
}

TEST(SelectPoints, TakesTheStrongestGradientsAwayFromTheSilhouette) {
  const PlaneScene scene;
  const GradientImage image = gradients_of(scene.image());
  const auto neighbours = seamless_neighbours(scene.mesh);
  const std::vector<std::uint8_t> usable(scene.mesh.positions.size(), 1);
  VertexView view;
  std::vector<std::uint32_t> one_thread;
  std::vector<std::uint32_t> four_threads;
  for (const int threads : {1, 4}) {
    project_vertices(surface_points(scene.mesh), scene.camera, scene.camera_from_object, {},
                     threads, view);
    // Hide the corner x, y > 5 cm, as an occluder would.
    for (std::size_t i = 0; i < view.rejection.size(); ++i) {
      if (scene.mesh.positions[i].head<2>().minCoeff() > 0.05f) {
        view.rejection[i] = VertexRejection::occluded;
      }
    }
    select_points(view, neighbours, usable, image, {.max_points = 500},
                  threads == 1 ? one_thread : four_threads);
  }
  EXPECT_EQ(one_thread, four_threads);
  ASSERT_EQ(one_thread.size(), 500u);
  double weakest = 1;
  for (const std::uint32_t i : one_thread) {
    ASSERT_EQ(view.rejection[i], VertexRejection::none);
    for (const std::uint32_t next : neighbours.of(i)) {
      EXPECT_EQ(view.rejection[next], VertexRejection::none) << "beside the hidden corner";
    }
    const Eigen::Vector2d pixel(static_cast<double>(view.x_px[i]),
                                static_cast<double>(view.y_px[i]));
    weakest = std::min(weakest, image.read(pixel)->gradient.norm());
  }
  EXPECT_GE(weakest, 0.008);
}

TEST(SelectPoints, TakesNothingUnusable) {
  const PlaneScene scene;
  VertexView view;
  project_vertices(surface_points(scene.mesh), scene.camera, scene.camera_from_object, {}, 1, view);
  std::vector<std::uint32_t> selected{7};
  select_points(view, seamless_neighbours(scene.mesh),
                std::vector<std::uint8_t>(scene.mesh.positions.size(), 0),
                gradients_of(scene.image()), {}, selected);
  EXPECT_TRUE(selected.empty());
}

TEST(SeamlessNeighbours, CrossASeamBothWays) {
  // Two grids of 2 x 2 vertices, the second at the same place: each vertex finds its double.
  const Mesh grid = testing::square_grid(1, 1.0f, 0.0f);
  const auto neighbours = seamless_neighbours(testing::together(grid, grid));
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto first = neighbours.of(i);
    const auto second = neighbours.of(i + 4);
    EXPECT_EQ(std::count(first.begin(), first.end(), i + 4), 1);
    EXPECT_EQ(std::count(second.begin(), second.end(), i), 1);
    EXPECT_EQ(first.size(), second.size());
  }
}

TEST(EstimateGain, IsExactWhenTheImageIsScaled) {
  // Numbers with few bits and a factor of 3/4: products and quotients are exact in binary.
  std::vector<float> predicted;
  std::vector<float> measured;
  for (int i = 64; i < 320; ++i) {
    predicted.push_back(static_cast<float>(i) / 512);
    measured.push_back(predicted.back() * 0.75f);
  }
  std::vector<double> scratch;
  const auto gain = estimate_gain(measured, predicted, {.min_pairs = 100}, scratch);
  ASSERT_TRUE(gain);
  EXPECT_EQ(*gain, 0.75);
}

TEST(EstimateGain, LooksPastAThirdOfOutliersAndClippedPixels) {
  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> level(0.2f, 0.7f);
  std::vector<float> predicted;
  std::vector<float> measured;
  for (int i = 0; i < 900; ++i) {
    predicted.push_back(level(random));
    // Outliers on either side balance out: the median is that of the two thirds that agree.
    measured.push_back(i % 6 == 0 ? 0.1f : i % 6 == 1 ? 0.9f : predicted.back() * 1.25f);
  }
  for (int i = 0; i < 500; ++i) {
    predicted.push_back(0.5f);
    measured.push_back(1.0f);  // clipped: must not count
  }
  std::vector<double> scratch;
  const auto gain = estimate_gain(measured, predicted, {}, scratch);
  ASSERT_TRUE(gain);
  EXPECT_NEAR(*gain, 1.25, 1e-6);
}

TEST(EstimateGain, HasNoAnswerForTooLittleOrTooMuch) {
  std::vector<double> scratch;
  EXPECT_FALSE(estimate_gain({}, {}, {}, scratch));
  const std::vector<float> dim(300, 0.1f);
  const std::vector<float> bright(300, 0.8f);
  EXPECT_FALSE(estimate_gain(bright, dim, {}, scratch)) << "a factor of 8 is no exposure drift";
  const std::vector<float> nan(300, std::nanf(""));
  EXPECT_FALSE(estimate_gain(nan, bright, {}, scratch));
}

}  // namespace
}  // namespace sheen::core
