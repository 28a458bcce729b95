// SPDX-License-Identifier: MIT
#include "capture/pose/tag_detector.h"
#include "capture/synthetic/baked_light.h"
#include "capture/synthetic/brdf.h"
#include "capture/synthetic/camera_path.h"
#include "capture/synthetic/lighting.h"
#include "capture/synthetic/render_camera.h"
#include "capture/synthetic/synthetic_session.h"
#include "capture/synthetic/torus_knot.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace sheen::capture::synthetic {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// A studio with one soft box and a black room.
Studio lit_from(const Eigen::Vector3f& towards, float irradiance, float radius_rad) {
  Studio studio;
  studio.boxes[0] = {towards, Eigen::Vector3f::Constant(irradiance), radius_rad};
  return studio;
}

/// Only soft box 0 is seen, and nothing else shines.
Incident first_box_only() {
  Incident incident;
  incident.visible[0] = 1;
  return incident;
}

/// Integral over the hemisphere of eyes of radiance times cosine: the flux a patch sends out per
/// area.
double reflected_flux(const Brdf& brdf, const Studio& studio) {
  constexpr int rings = 400;
  constexpr int sectors = 400;
  double flux = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const float cosine = (static_cast<float>(ring) + 0.5f) / rings;
    const float sine = std::sqrt(1 - cosine * cosine);
    for (int sector = 0; sector < sectors; ++sector) {
      const float phi = 2 * kPi * (static_cast<float>(sector) + 0.5f) / sectors;
      const Eigen::Vector3f eye(sine * std::cos(phi), sine * std::sin(phi), cosine);
      const Eigen::Vector3f radiance =
          reflected_radiance(brdf, Eigen::Vector3f::UnitZ(), eye, studio, first_box_only());
      flux += static_cast<double>(radiance.x() * cosine);
    }
  }
  return flux * 2 * std::numbers::pi / (rings * sectors);
}

TEST(Lighting, LambertPatchUnderOneLight) {
  Brdf brdf;
  brdf.albedo = {0.8f, 0.4f, 0.2f};
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const Eigen::Vector3f eye = Eigen::Vector3f(0.6f, 0, 0.8f);

  // Head on, the irradiance is E = 3: L = albedo E / pi towards every eye.
  const Eigen::Vector3f head_on =
      reflected_radiance(brdf, up, eye, lit_from(up, 3, 0.2f), first_box_only());
  EXPECT_LT((head_on - brdf.albedo * 3 / kPi).norm(), 1e-6f);

  // At 60 degrees the patch catches half of it.
  const Eigen::Vector3f slanted(std::sin(kPi / 3), 0, std::cos(kPi / 3));
  const Eigen::Vector3f oblique =
      reflected_radiance(brdf, up, eye, lit_from(slanted, 3, 0.2f), first_box_only());
  EXPECT_LT((oblique - brdf.albedo * 1.5f / kPi).norm(), 1e-6f);

  // From below nothing is seen.
  EXPECT_EQ(reflected_radiance(brdf, up, -eye, lit_from(up, 3, 0.2f), first_box_only()),
            Eigen::Vector3f::Zero());
}

TEST(Lighting, EnamelSendsOutNoMoreThanItReceives) {
  Brdf brdf;
  brdf.albedo = Eigen::Vector3f::Constant(0.9f);
  brdf.specular = 0.2f;
  for (const float alpha : {0.1f, 0.2f, 0.5f}) {
    for (const float angle : {0.0f, 0.7f, 1.3f}) {
      brdf.alpha = alpha;
      const Eigen::Vector3f towards(std::sin(angle), 0, std::cos(angle));
      // Received per area: E cos(angle) with E = 1.
      EXPECT_LE(reflected_flux(brdf, lit_from(towards, 1, 0.1f)),
                static_cast<double>(std::cos(angle)))
          << "alpha " << alpha << " angle " << angle;
    }
  }
}

TEST(Lighting, PerfectMirrorLobeKeepsItsEnergy) {
  // Reflectance 1 at every angle and a narrow lobe seen head on: GGX is normalised and masking is
  // negligible, so everything received is sent out. Masking takes about alpha^2 = 1 %.
  Brdf mirror;
  mirror.specular = 1;
  mirror.alpha = 0.1f;
  const double flux = reflected_flux(mirror, lit_from(Eigen::Vector3f::UnitZ(), 1, 0));
  EXPECT_LT(flux, 1.0);
  EXPECT_GT(flux, 0.98);
}

TEST(Lighting, OpenGroundReceivesTheClosedForm) {
  // Boxes: sum of E_i sin(elevation_i). Room: L = h + (z - h) cos(theta), so that the integral of
  // L cos over the hemisphere is pi h + 2 pi / 3 (z - h).
  const Studio studio = product_studio();
  const float difference = studio.zenith.x() - studio.horizon.x();
  float expected = kPi * studio.horizon.x() + 2 * kPi / 3 * difference;
  for (const SoftBox& box : studio.boxes) expected += box.irradiance.x() * box.towards.z();

  const core::Mesh knot = torus_knot(kMinKnotVertices);
  const core::RayCaster caster(knot);
  const GroundLight ground(studio, caster, 0.2f, 1);
  // The room is summed over about 96 directions: 1 % of its share.
  EXPECT_NEAR(ground.irradiance(100, 0).x(), expected, 0.01f * expected);
  EXPECT_LT(ground.irradiance(0.045f, 0).x(), 0.8f * expected);
}

TEST(Brdf, IsAReflectanceEverywhere) {
  constexpr unsigned seed = 20240611;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-0.1f, 0.1f);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f point(place(random), place(random), place(random));
    for (const SceneKind kind : {SceneKind::matte, SceneKind::mixed, SceneKind::glossy,
                                 SceneKind::textured, SceneKind::white}) {
      const Brdf brdf = brdf_at(kind, point, 0.013f);
      ASSERT_GT(brdf.albedo.minCoeff(), 0);
      ASSERT_LE(brdf.albedo.maxCoeff(), 1);
      ASSERT_TRUE(brdf.specular >= 0 && brdf.specular <= 1);
      ASSERT_TRUE(kind != SceneKind::matte || brdf.specular == 0);
      ASSERT_TRUE(kind != SceneKind::glossy || brdf.specular > 0);
    }
  }
}

TEST(TorusKnot, IsWatertightWithUnitNormalsThatFaceOutwards) {
  const core::Mesh knot = torus_knot(4000);
  EXPECT_NEAR(static_cast<double>(knot.positions.size()), 4000, 40);

  // Every directed edge once and its opposite once: closed, consistently oriented, no border.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0;
  for (const auto& triangle : knot.triangles) {
    for (int i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
    const Eigen::Vector3f& a = knot.positions[triangle.x()];
    const Eigen::Vector3f& b = knot.positions[triangle.y()];
    const Eigen::Vector3f& c = knot.positions[triangle.z()];
    const Eigen::Vector3f face = (b - a).cross(c - a);
    volume += static_cast<double>(a.dot(b.cross(c))) / 6;
    for (const std::uint32_t vertex : {triangle.x(), triangle.y(), triangle.z()}) {
      EXPECT_GT(face.normalized().dot(knot.normals[vertex]), 0.8f);
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_GT(volume, 0);
  for (const Eigen::Vector3f& normal : knot.normals) EXPECT_NEAR(normal.norm(), 1, 1e-6f);
}

TEST(TorusKnot, HasTheVolumeOfATube) {
  // Pappus: a tube of radius r along a closed curve of length l that does not meet itself has area
  // 2 pi r l and volume pi r^2 l, hence V = A r / 2 with r = 12.5 mm. The inscribed polygon with
  // n = 116 sides is too small by about (2 pi / n)^2 / 6 = 5e-4 in area and twice that in volume.
  const core::Mesh knot = torus_knot(100'000);
  double volume = 0;
  double area = 0;
  for (const auto& triangle : knot.triangles) {
    const Eigen::Vector3d a = knot.positions[triangle.x()].cast<double>();
    const Eigen::Vector3d b = knot.positions[triangle.y()].cast<double>();
    const Eigen::Vector3d c = knot.positions[triangle.z()].cast<double>();
    volume += a.dot(b.cross(c)) / 6;
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  EXPECT_NEAR(volume / (area * 0.0125 / 2), 1, 1e-3);
}

TEST(CameraPath, StaysInItsBandAndMovesSmoothly) {
  const Eigen::Vector3d centre(0, 0, 0.05);
  constexpr double radius = 0.07;
  constexpr int frames = 120;
  const CameraPath path(recording_path(1), centre, radius);
  std::vector<Eigen::Vector3d> eyes;
  for (int i = 0; i < frames; ++i) {
    const Eigen::Isometry3d pose = path.board_from_camera(i / (frames - 1.0));
    const Eigen::Vector3d outward = pose.translation() - centre;
    const double elevation_deg = std::asin(outward.z() / outward.norm()) * 180 / std::numbers::pi;
    EXPECT_GT(elevation_deg, 25);
    EXPECT_LT(elevation_deg, 65);
    EXPECT_GT(outward.norm(), 0.3);
    EXPECT_LT(outward.norm(), 0.5);
    EXPECT_NEAR((pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm(), 0,
                1e-12);
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
    // The aim misses the centre by less than 0.13 sqrt(3) radii.
    const Eigen::Vector3d aim = pose.inverse() * centre;
    EXPECT_LT(std::hypot(aim.x(), aim.y()), 0.13 * std::sqrt(3.0) * radius);
    eyes.push_back(pose.translation());
  }
  // Three rounds of radius < 0.42 cos(28 deg) in 119 steps: 2 pi * 3 * 0.37 / 119 = 59 mm a step at
  // most from the walk, tremor included well under 90 mm; a change of direction of 9 degrees a step
  // bends it by 59 * 0.16 = 9 mm.
  for (std::size_t i = 2; i < eyes.size(); ++i) {
    EXPECT_LT((eyes[i] - eyes[i - 1]).norm(), 0.09);
    EXPECT_LT((eyes[i] - 2 * eyes[i - 1] + eyes[i - 2]).norm(), 0.025);
  }
}

/// One small scene for the tests that look at it.
// One round at one elevation and distance, held-out views half way between frames.
TEST(CameraPath, TurntableStandsStill) {
  const Eigen::Vector3d centre(0.01, 0.02, 0.05);
  const CameraPath path(turntable_path(2.5), centre, 0.06);
  const Eigen::Vector3d first = path.board_from_camera(0).translation() - centre;
  EXPECT_NEAR(std::atan2(first.y(), first.x()), 2.5 * std::numbers::pi / 180, 1e-9);
  for (int i = 1; i <= 72; ++i) {
    const Eigen::Isometry3d pose = path.board_from_camera(i / 72.0);
    const Eigen::Vector3d eye = pose.translation() - centre;
    EXPECT_NEAR(eye.norm(), first.norm(), 1e-9);
    EXPECT_NEAR(eye.z(), first.z(), 1e-9);
    EXPECT_NEAR(pose.linear().col(0).z(), 0, 1e-9);  // rows are level
  }
}

class SceneTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { scene_ = std::make_unique<Scene>(make_scene(options())); }
  static void TearDownTestSuite() { scene_.reset(); }
  static SyntheticOptions options() {
    SyntheticOptions options;
    options.vertices = 3000;
    return options;
  }
  static Eigen::Isometry3d view(double t) {
    return CameraPath(recording_path(1), scene_->object_centre(), scene_->object_radius_m())
        .board_from_camera(t);
  }
  inline static std::unique_ptr<Scene> scene_;
};

TEST_F(SceneTest, RadianceDependsOnPlaceAndDirectionAlone) {
  // Walking along a ray changes neither the place it meets nor its direction.
  const Eigen::Vector3f eye = view(0.3).translation().cast<float>();
  const Eigen::Vector3f centre = scene_->object_centre().cast<float>();
  int on_object = 0;
  for (int i = 0; i < 200; ++i) {
    const float angle = 0.4f * static_cast<float>(i);
    const Eigen::Vector3f target =
        centre +
        0.0003f * static_cast<float>(i) * Eigen::Vector3f(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3f direction = (target - eye).normalized();
    const Scene::Sight far = scene_->trace(eye, direction);
    const Scene::Sight near = scene_->trace(eye + 0.15f * direction, direction);
    ASSERT_EQ(far.on_object, near.on_object);
    if (!far.on_object) continue;
    ++on_object;
    EXPECT_LT((far.value - near.value).norm(), 2e-3f);
  }
  EXPECT_GT(on_object, 50);
}

TEST_F(SceneTest, HardlyAnyPixelOfTheObjectSaturates) {
  const RenderCamera render_camera(synthetic_camera(320, 180));
  int pixels = 0;
  int saturated = 0;
  for (const double t : {0.05, 0.3, 0.55, 0.8}) {
    const Exposure exposure = render_camera.expose(*scene_, view(t), 2, 1, 1);
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 320; ++x) {
        if (exposure.object.at<float>(y, x) < 1) continue;
        const cv::Vec3f light = exposure.light.at<cv::Vec3f>(y, x);
        ++pixels;
        if (std::max({light[0], light[1], light[2]}) > 1) ++saturated;
      }
    }
  }
  EXPECT_GT(pixels, 4 * 320 * 180 / 20);
  EXPECT_LT(saturated, pixels / 50);
}

TEST_F(SceneTest, ImageDoesNotDependOnThreads) {
  const RenderCamera render_camera(synthetic_camera(320, 180));
  const Exposure one = render_camera.expose(*scene_, view(0.5), 2, 7, 1);
  const Exposure three = render_camera.expose(*scene_, view(0.5), 2, 7, 3);
  EXPECT_EQ(cv::norm(one.light, three.light, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(one.object, three.object, cv::NORM_INF), 0);
}

TEST_F(SceneTest, DetectorFindsTheTagsWhereTheyProject) {
  const core::CameraModel camera = synthetic_camera(800, 450);
  const RenderCamera render_camera(camera);
  const Eigen::Isometry3d pose = view(0.6);

  // Detect in linear light: sRGB brightens pixels that are half black, which moves the edges of
  // black squares inwards by a fifth of a pixel, on every camera.
  const Exposure exposure = render_camera.expose(*scene_, pose, 16, 3, 2);
  cv::Mat grey;
  cv::cvtColor(exposure.light, grey, cv::COLOR_RGB2GRAY);
  grey.convertTo(grey, CV_8U, 255);
  const auto family = find_tag_family("tag36h11", 1);
  ASSERT_TRUE(family);
  const std::vector<TagDetection> detections = TagDetector(*family).detect(grey);
  ASSERT_GE(detections.size(), 15U);

  // A print that is mirrored or turned would be off by a tag's width, a wrong pixel centre by half
  // a pixel. Tags that the object or the border touches are left out: their edges are not all
  // there.
  Eigen::Vector2d bias = Eigen::Vector2d::Zero();
  double squares = 0;
  int corners_compared = 0;
  for (const TagDetection& detection : detections) {
    std::vector<cv::Point2f> outline;
    for (const Eigen::Vector2d& corner : detection.corners_px) {
      outline.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    }
    const cv::Rect tight = cv::boundingRect(outline);
    const cv::Rect wide(tight.x - 6, tight.y - 6, tight.width + 12, tight.height + 12);
    if ((wide & cv::Rect(0, 0, grey.cols, grey.rows)) != wide) continue;
    if (cv::countNonZero(exposure.object(wide)) > 0) continue;

    const auto corners = scene_->board().tags.at(detection.id).corners_in_board();
    for (std::size_t i = 0; i < 4; ++i) {
      const auto expected = camera.project(pose.inverse() * corners[i]);
      ASSERT_TRUE(expected);
      const Eigen::Vector2d miss = detection.corners_px[i] - *expected;
      EXPECT_LT(miss.norm(), 0.4) << "tag " << detection.id << " corner " << i;
      bias += miss;
      squares += miss.squaredNorm();
      ++corners_compared;
    }
  }
  EXPECT_GE(corners_compared, 40);
  EXPECT_LT((bias / corners_compared).norm(), 0.03);
  EXPECT_LT(std::sqrt(squares / corners_compared), 0.15);
}

}  // namespace
}  // namespace sheen::capture::synthetic
