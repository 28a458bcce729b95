// SPDX-License-Identifier: MIT
#include "evaluation/study/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

Vector3f direction(float polar, float azimuth) {
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
          std::cos(polar)};
}

// Integral of f_r cos over the hemisphere of light directions, midpoint rule.
double directional_albedo(const Material& material, const Vector3f& view) {
  constexpr int polar_steps = 256;
  constexpr int azimuth_steps = 256;
  constexpr float half_pi = std::numbers::pi_v<float> / 2;
  double sum = 0;
  for (int i = 0; i < polar_steps; ++i) {
    const float polar = (static_cast<float>(i) + 0.5f) * half_pi / polar_steps;
    for (int k = 0; k < azimuth_steps; ++k) {
      const float azimuth = (static_cast<float>(k) + 0.5f) * 4 * half_pi / azimuth_steps;
      const Vector3f light = direction(polar, azimuth);
      sum += static_cast<double>(reflectance(material, light, view).x() * std::cos(polar) *
                                 std::sin(polar));
    }
  }
  return sum * static_cast<double>(half_pi / polar_steps) *
         static_cast<double>(4 * half_pi / azimuth_steps);
}

TEST(Material, IsReciprocal) {
  for (const MaterialClass material_class : kMaterialClasses) {
    Random random(7);
    const Material material = random_material(material_class, random);
    for (int i = 0; i < 20; ++i) {
      const Vector3f light = random.on_sphere(0.1f);
      const Vector3f view = random.on_sphere(0.1f);
      const Vector3f forward = reflectance(material, light, view);
      const Vector3f backward = reflectance(material, view, light);
      EXPECT_NEAR((forward - backward).norm() / forward.norm(), 0.0f, 1e-4f)
          << name_of(material_class);
    }
  }
}

// Lambert: the integral of albedo / pi * cos over the hemisphere is the albedo.
TEST(Material, LambertReflectsItsAlbedo) {
  Material material;
  material.albedo = Vector3f::Constant(0.5f);
  EXPECT_NEAR(directional_albedo(material, direction(0.7f, 0.3f)), 0.5, 1e-4);
}

// With F0 = 1 Schlick's term is 1 everywhere: single scattering loses light between the facets and
// never adds any. Seen from above, facets steeper than 45 degrees send it below the horizon: of GGX
// that is the part alpha^2 / (1 + alpha^2), .022 for alpha = .15. Shadowing takes less than that
// again.
TEST(Material, MirrorReflectsNoMoreThanItGets) {
  Material material;
  material.f0 = Vector3f::Ones();
  for (const float alpha : {0.15f, 0.25f, 0.4f, 0.6f}) {
    material.alpha_x = material.alpha_y = alpha;
    for (const float polar : {0.05f, 0.6f, 1.1f, 1.4f}) {
      EXPECT_LE(directional_albedo(material, direction(polar, 0.4f)), 1.0 + 2e-3) << alpha;
    }
  }
  material.alpha_x = material.alpha_y = 0.15f;
  const double lost = 1.0 - directional_albedo(material, direction(0.05f, 0.4f));
  EXPECT_GT(lost, 0.022 - 2e-3);
  EXPECT_LT(lost, 2 * 0.022);
}

// The distribution of normals is normalised: integral of D cos(h) over the hemisphere is 1. D is
// taken from the reflectance itself: with light = view = h the half vector is h, so
// f = F0 D / ((1 + 2 Lambda) 4 cos^2).
TEST(Material, DistributionOfNormalsIsNormalised) {
  Material material;
  material.f0 = Vector3f::Ones();
  material.alpha_x = 0.5f;
  material.alpha_y = 0.2f;
  constexpr int steps = 512;
  constexpr float half_pi = std::numbers::pi_v<float> / 2;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const float polar = (static_cast<float>(i) + 0.5f) * half_pi / steps;
    for (int k = 0; k < steps; ++k) {
      const float azimuth = (static_cast<float>(k) + 0.5f) * 4 * half_pi / steps;
      const Vector3f h = direction(polar, azimuth);
      const float distribution =
          reflectance(material, h, h).x() * 4 * h.z() * h.z() * (1 + 2 * smith_lambda(material, h));
      sum += static_cast<double>(distribution * h.z() * std::sin(polar));
    }
  }
  sum *= static_cast<double>(half_pi / steps) * static_cast<double>(4 * half_pi / steps);
  EXPECT_NEAR(sum, 1.0, 1e-3);
}

}  // namespace
}  // namespace sheen::evaluation
