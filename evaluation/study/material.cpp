// SPDX-License-Identifier: MIT
#include "evaluation/study/material.h"

#include <cmath>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;


Vector3f random_colour(Random& random, float low, float high) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

// A metal over a dark ground: one strength, slightly tinted.
Material metal(float alpha_x, float alpha_y, Random& random) {
  const float strength = random.uniform(0.35f, 0.75f);
  return {random_colour(random, 0.02f, 0.15f), strength * random_colour(random, 0.8f, 1.0f),
          alpha_x, alpha_y};
}

Material coated(float f0, float alpha, Random& random) {
  return {random_colour(random, 0.10f, 0.60f), Vector3f::Constant(f0), alpha, alpha};
}

}  // namespace

std::string_view name_of(MaterialClass material) {
  switch (material) {
    case MaterialClass::lambert:
      return "lambert";
    case MaterialClass::ggx60:
      return "ggx.60";
    case MaterialClass::ggx40:
      return "ggx.40";
    case MaterialClass::ggx25:
      return "ggx.25";
    case MaterialClass::ggx15:
      return "ggx.15";
    case MaterialClass::ggx08:
      return "ggx.08";
    case MaterialClass::mix:
      return "mix";
    case MaterialClass::anisotropic:
      return "anisotropic";
    case MaterialClass::fresnel:
      break;
  }
  return "fresnel";
}

Material random_material(MaterialClass material, Random& random) {
  switch (material) {
    case MaterialClass::lambert:
      return {random_colour(random, 0.15f, 0.85f), Vector3f::Zero(), 1.0f, 1.0f};
    case MaterialClass::ggx60:
      return metal(0.60f, 0.60f, random);
    case MaterialClass::ggx40:
      return metal(0.40f, 0.40f, random);
    case MaterialClass::ggx25:
      return metal(0.25f, 0.25f, random);
    case MaterialClass::ggx15:
      return metal(0.15f, 0.15f, random);
    case MaterialClass::ggx08:
      return metal(0.08f, 0.08f, random);
    case MaterialClass::mix:
      return coated(0.06f, 0.15f, random);
    case MaterialClass::anisotropic:
      return metal(0.50f, 0.10f, random);
    case MaterialClass::fresnel:
      break;
  }
  return coated(0.04f, 0.10f, random);
}

float smith_lambda(const Material& material, const Vector3f& direction) {
  const float along = material.alpha_x * direction.x();
  const float across = material.alpha_y * direction.y();
  const float squared = (along * along + across * across) / (direction.z() * direction.z());
  return 0.5f * (std::sqrt(1.0f + squared) - 1.0f);
}

Vector3f reflectance(const Material& material, const Vector3f& light, const Vector3f& view) {
  const Vector3f diffuse = material.albedo / std::numbers::pi_v<float>;
  if (!material.is_glossy()) return diffuse;
  const Vector3f half = (light + view).normalized();
  const float x = half.x() / material.alpha_x;
  const float y = half.y() / material.alpha_y;
  const float stretched = x * x + y * y + half.z() * half.z();
  const float distribution =
      1.0f / (std::numbers::pi_v<float> * material.alpha_x * material.alpha_y * stretched * stretched);
  const float shadowing =
      1.0f / (1.0f + smith_lambda(material, light) + smith_lambda(material, view));
  const float m = 1.0f - half.dot(view);
  const float schlick = m * m * m * m * m;
  const Vector3f fresnel = material.f0 + (Vector3f::Ones() - material.f0) * schlick;
  return diffuse + fresnel * (distribution * shadowing / (4.0f * light.z() * view.z()));
}

}  // namespace sheen::evaluation
