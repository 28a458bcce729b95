// SPDX-License-Identifier: MIT
#include "evaluation/study/lumisphere.h"

#include "evaluation/study/test_bed.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

TEST(Lumisphere, OfLambertIsTheSameFromEverywhere) {
  Random random(1);
  const Material material = random_material(MaterialClass::lambert, random);
  const Lumisphere lumisphere(material, Matrix3f::Identity(), studio_environment());
  const Vector3f from_above = lumisphere.radiance({0, 0, 1});
  EXPECT_GT(from_above.minCoeff(), 0.0f);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(lumisphere.radiance(random.on_sphere(kMinCosine)), from_above);
  }
}

// Definition: sum over the lights of f_r(light, view) cos(light) power.
TEST(Lumisphere, IsTheSumOfReflectanceOverTheLights) {
  const Environment environment = studio_environment();
  for (const MaterialClass material_class : kMaterialClasses) {
    Random random(2);
    const Material material = random_material(material_class, random);
    const Lumisphere lumisphere(material, Matrix3f::Identity(), environment);
    for (int i = 0; i < 5; ++i) {
      const Vector3f view = random.on_sphere(kMinCosine);
      Vector3f expected = Vector3f::Zero();
      for (std::size_t k = 0; k < environment.direction.size(); ++k) {
        const Vector3f& light = environment.direction[k];
        if (light.z() < 1e-3f) continue;
        expected +=
            reflectance(material, light, view).cwiseProduct(environment.power[k]) * light.z();
      }
      EXPECT_NEAR((lumisphere.radiance(view) - expected).norm() / expected.norm(), 0.0f, 1e-4f)
          << name_of(material_class);
    }
  }
}

// Turning world and patch together changes nothing.
TEST(Lumisphere, DoesNotDependOnTheWorldsOrientation) {
  Random random(3);
  const Material material = random_material(MaterialClass::anisotropic, random);
  const Matrix3f turn = Eigen::AngleAxisf(0.7f, Vector3f(1, 2, -1).normalized()).toRotationMatrix();
  Environment environment = studio_environment();
  const Lumisphere before(material, Matrix3f::Identity(), environment);
  for (Vector3f& direction : environment.direction) direction = turn * direction;
  const Lumisphere after(material, turn, environment);
  // A light that rounding carries across the horizon has a cosine below 1e-3 and adds less than
  // that.
  const Vector3f view = Vector3f(0.3f, -0.4f, 0.8f).normalized();
  EXPECT_NEAR((before.radiance(view) - after.radiance(view)).norm(), 0.0f, 1e-3f);
}

// The study's exposure: no glossy class clamps more than 11 % of its samples, and the sharpest ones
// do clamp.
TEST(TestBed, SharpestHighlightsClampAFewPercent) {
  TestBedOptions options;
  options.points_per_material = 10;
  for (const MaterialClass material : kMaterialClasses) {
    options.materials = {material};
    const double clamped = clamped_fraction(options, studio_environment());
    EXPECT_LE(clamped, 0.11) << name_of(material);
    if (material == MaterialClass::lambert) {
      EXPECT_EQ(clamped, 0.0);
    }
    if (material == MaterialClass::ggx08) {
      EXPECT_GT(clamped, 0.01);
    }
  }
}

// More views are more samples, not other ones: each sample for N is among those for 2 N.
TEST(TestBed, SamplesForMoreViewsIncludeThoseForFewer) {
  for (const ViewSet views : kViewSets) {
    TestBedOptions options;
    options.materials = {MaterialClass::ggx25};
    options.points_per_material = 1;
    options.views = views;
    options.training_views = 16;
    const StudySet few = make_test_bed(options, studio_environment());
    options.training_views = 32;
    const StudySet many = make_test_bed(options, studio_environment());
    for (const TrainingSample& sample : few.points[0].training) {
      const auto& all = many.points[0].training;
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const TrainingSample& other) {
        return other.uv == sample.uv && other.rgb == sample.rgb;
      })) << name_of(views);
    }
    // The tests stay the same.
    EXPECT_EQ(few.points[0].test[5].uv, many.points[0].test[5].uv);
    EXPECT_EQ(few.points[0].test[5].rgb, many.points[0].test[5].rgb);
  }
}

TEST(TestBed, BatchesHoldEverySampleOnceInTheOrderOfTime) {
  TestBedOptions options;
  options.points_per_material = 1;
  options.training_views = 8;
  const StudySet set = make_test_bed(options, studio_environment());
  const auto batches = set.batches();
  ASSERT_EQ(batches.size(), 8u);
  for (std::size_t frame = 0; frame < batches.size(); ++frame) {
    ASSERT_EQ(batches[frame].size(), set.points.size());
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      EXPECT_EQ(batches[frame].patch[i], i);
      EXPECT_EQ(batches[frame].u[i], set.points[i].training[frame].uv.x());
      EXPECT_EQ(batches[frame].b[i], set.points[i].training[frame].rgb.z());
    }
  }
}

// Samples are display values: multiples of 1/255 in [0, 1], whatever is done to them.
TEST(Corruption, ClampsAndRounds) {
  Random random(4);
  const Corruption corruption{.noise = 0.05f, .outliers = 0.1f};
  for (int i = 0; i < 200; ++i) {
    const Vector3f colour = photographed({1.5f, 0.5f, 0.01f}, corruption, random);
    for (const float value : {colour.x(), colour.y(), colour.z()}) {
      EXPECT_GE(value, 0.0f);
      EXPECT_LE(value, 1.0f);
      EXPECT_NEAR(value * 255.0f, std::round(value * 255.0f), 1e-3f);
    }
  }
}

// Pose error of s degrees about both axes: the mean squared angle is 2 s^2.
TEST(Corruption, PoseErrorHasTheAngleItSays) {
  Random random(5);
  const Corruption corruption{.pose_error = 1.5f};
  constexpr int count = 5000;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const Vector3f turned = with_pose_error({0, 0.6f, 0.8f}, corruption, random);
    const double sine = static_cast<double>(turned.cross(Vector3f(0, 0.6f, 0.8f)).norm());
    squares += std::asin(sine) * std::asin(sine);
  }
  const double degrees = std::sqrt(squares / count) * 180.0 / std::numbers::pi;
  // Standard error of the mean square is its value / sqrt(5000) = 1.4 %, of the root half of it.
  EXPECT_NEAR(degrees, 1.5 * std::numbers::sqrt2, 0.036 * 1.5 * std::numbers::sqrt2);
}

}  // namespace
}  // namespace sheen::evaluation
