// SPDX-License-Identifier: MIT
#include "capture/synthetic/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::capture::synthetic {
namespace {


SoftBox soft_box(float azimuth_deg, float elevation_deg, float radius_deg,
                 const Eigen::Vector3f& irradiance) {
  const float azimuth = azimuth_deg * std::numbers::pi_v<float> / 180;
  const float elevation = elevation_deg * std::numbers::pi_v<float> / 180;
  return {{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
           std::sin(elevation)},
          irradiance,
          radius_deg * std::numbers::pi_v<float> / 180};
}

float schlick(float f0, float cosine) {
  const float m = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return f0 + (1 - f0) * m * m * m * m * m;
}

/// GGX distribution times Smith's height-correlated visibility (the G / (4 cos cos) of the lobe).
float ggx(float alpha, float cos_half, float cos_light, float cos_eye) {
  const float a2 = alpha * alpha;
  const float d = cos_half * cos_half * (a2 - 1) + 1;
  const float distribution = a2 / (std::numbers::pi_v<float> * d * d);
  const float light = cos_eye * std::sqrt(cos_light * cos_light * (1 - a2) + a2);
  const float eye = cos_light * std::sqrt(cos_eye * cos_eye * (1 - a2) + a2);
  return distribution * 0.5f / std::max(light + eye, 1e-6f);
}

/// Share of a soft box's light that goes to the eye, per unit of irradiance: BRDF times cosine.
Eigen::Vector3f lobe(const Brdf& brdf, const Eigen::Vector3f& normal,
                     const Eigen::Vector3f& towards_eye, const SoftBox& box) {
  const float cos_light = normal.dot(box.towards);
  if (cos_light <= 0) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f diffuse = brdf.albedo / std::numbers::pi_v<float>;
  if (brdf.specular <= 0) return diffuse * cos_light;

  // Widen the lobe: a cone of half angle r is spread over half vectors by r / 2.
  const float alpha = std::min(std::hypot(brdf.alpha, box.radius_rad / 2), 1.0f);
  const float cos_eye = normal.dot(towards_eye);
  const Eigen::Vector3f half = (box.towards + towards_eye).normalized();
  const float gloss = schlick(brdf.specular, half.dot(towards_eye)) *
                      ggx(alpha, normal.dot(half), cos_light, cos_eye);

  // Light enters and leaves the body through the coat, so that the sum keeps within what arrives.
  const float passed =
      (1 - schlick(brdf.specular, cos_light)) * (1 - schlick(brdf.specular, cos_eye));
  return (passed * diffuse + Eigen::Vector3f::Constant(gloss)) * cos_light;
}

}  // namespace

Studio product_studio() {
  Studio studio;
  studio.boxes = {soft_box(35, 52, 13, {2.95f, 2.78f, 2.50f}),    // key, warm
                  soft_box(205, 44, 20, {0.95f, 1.05f, 1.18f}),   // fill, cool
                  soft_box(300, 72, 22, {0.85f, 0.85f, 0.85f}),   // top
                  soft_box(120, 30, 14, {0.80f, 0.76f, 0.70f})};  // low rim
  studio.zenith = {0.30f, 0.32f, 0.35f};
  studio.horizon = {0.10f, 0.10f, 0.11f};
  studio.exposure = 0.66f;
  return studio;
}

Eigen::Vector3f room_radiance(const Studio& studio, const Eigen::Vector3f& direction) {
  const float height = std::max(direction.z(), 0.0f);
  return studio.horizon + height * (studio.zenith - studio.horizon);
}

Eigen::Vector3f reflected_radiance(const Brdf& brdf, const Eigen::Vector3f& normal,
                                   const Eigen::Vector3f& towards_eye, const Studio& studio,
                                   const Incident& incident) {
  const float cos_eye = normal.dot(towards_eye);
  if (cos_eye <= 0) return Eigen::Vector3f::Zero();

  // Add the soft boxes the point sees.
  Eigen::Vector3f radiance = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < kSoftBoxes; ++i) {
    if (incident.visible[i] <= 0) continue;
    const SoftBox& box = studio.boxes[i];
    radiance +=
        incident.visible[i] * lobe(brdf, normal, towards_eye, box).cwiseProduct(box.irradiance);
  }

  // Add the room: diffusely, and mirrored at the strength of the Fresnel term.
  const float fresnel = brdf.specular > 0 ? schlick(brdf.specular, cos_eye) : 0.0f;
  radiance += (1 - fresnel) * brdf.albedo.cwiseProduct(incident.ambient_irradiance) / std::numbers::pi_v<float>;
  if (fresnel > 0) {
    const Eigen::Vector3f mirrored = 2 * cos_eye * normal - towards_eye;
    radiance += fresnel * incident.openness * room_radiance(studio, mirrored);
  }
  return radiance;
}

}  // namespace sheen::capture::synthetic
