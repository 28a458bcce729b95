// SPDX-License-Identifier: MIT
#include "capture/synthetic/brdf.h"

#include "capture/synthetic/hash.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sheen::capture::synthetic {
namespace {

// The palette, linear RGB.
const Eigen::Vector3f kTeal(0.012f, 0.105f, 0.115f);
const Eigen::Vector3f kTerracotta(0.42f, 0.105f, 0.042f);
const Eigen::Vector3f kIvory(0.60f, 0.51f, 0.37f);
const Eigen::Vector3f kVein(0.05f, 0.035f, 0.025f);
const Eigen::Vector3f kPlaster(0.72f, 0.72f, 0.72f);
const Eigen::Vector3f kPrintInk(0.02f, 0.025f, 0.06f);

constexpr float kGlossySpecular = 0.20f;
constexpr float kGlossyAlpha = 0.20f;

float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

Eigen::Vector3f mix(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float t) {
  return a + t * (b - a);
}

/// Gradient of a lattice point, dotted with the offset from it.
float lattice_slope(std::int32_t x, std::int32_t y, std::int32_t z, const Eigen::Vector3f& offset) {
  const std::uint32_t bits = hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                  static_cast<std::uint32_t>(z));
  const Eigen::Vector3f gradient(static_cast<float>(bits & 1023U) - 511.5f,
                                 static_cast<float>((bits >> 10) & 1023U) - 511.5f,
                                 static_cast<float>((bits >> 20) & 1023U) - 511.5f);
  return gradient.dot(offset) / 511.5f;
}

/// Colour of the bands at phase `s`, period 4: teal, ivory, terracotta, ivory, softly joined.
Eigen::Vector3f band_colour(float s) {
  const float phase = s - 4 * std::floor(s / 4);
  const float teal = 1 - smooth_step(0.75f, 1.0f, phase) + smooth_step(3.0f, 3.25f, phase);
  const float terracotta = smooth_step(1.45f, 1.7f, phase) - smooth_step(2.55f, 2.8f, phase);
  return mix(mix(kIvory, kTeal, teal), kTerracotta, terracotta);
}

/// Share of ink at a place: hairlines along the zeros of a noise whose features are a fifth of the
/// bands' half width, as a transfer print has them.
float ink_at(const Eigen::Vector3f& p) {
  const float line = std::abs(smooth_noise(5.0f * p + Eigen::Vector3f(3.7f, 0.6f, 9.2f)));
  return 1 - smooth_step(0.06f, 0.16f, line);
}

}  // namespace

std::optional<SceneKind> scene_kind(std::string_view name) {
  for (std::size_t i = 0; i < kSceneNames.size(); ++i) {
    if (kSceneNames[i] == name) return static_cast<SceneKind>(i);
  }
  return std::nullopt;
}

float smooth_noise(const Eigen::Vector3f& point) {
  const Eigen::Vector3f base(std::floor(point.x()), std::floor(point.y()), std::floor(point.z()));
  const Eigen::Vector3f f = point - base;
  const auto x = static_cast<std::int32_t>(base.x());
  const auto y = static_cast<std::int32_t>(base.y());
  const auto z = static_cast<std::int32_t>(base.z());
  const auto fade = [](float t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const Eigen::Vector3f w(fade(f.x()), fade(f.y()), fade(f.z()));

  float value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1;
    const int j = (corner >> 1) & 1;
    const int k = corner >> 2;
    const Eigen::Vector3f at(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
    const float weight =
        (i ? w.x() : 1 - w.x()) * (j ? w.y() : 1 - w.y()) * (k ? w.z() : 1 - w.z());
    value += weight * lattice_slope(x + i, y + j, z + k, f - at);
  }
  return std::clamp(value, -1.0f, 1.0f);
}

Brdf brdf_at(SceneKind kind, const Eigen::Vector3f& point_in_object, float unit_m) {
  if (kind == SceneKind::white) return {kPlaster, 0, kGlossyAlpha};
  const Eigen::Vector3f p = point_in_object / unit_m;

  // Bend the bands and mottle them, both slowly and finely.
  const Eigen::Vector3f across = Eigen::Vector3f(0.74f, 0.42f, 0.52f);
  const float warp = smooth_noise(0.55f * p + Eigen::Vector3f(7.3f, 1.9f, 4.1f));
  const float mottle = smooth_noise(1.6f * p) + 0.5f * smooth_noise(2.4f * p);
  const float s = p.dot(across) * 0.9f + 0.9f * warp;
  Eigen::Vector3f albedo = band_colour(s) * (1 + 0.38f * mottle);

  // Draw dark veins where a second noise crosses zero.
  const float ridge = std::abs(smooth_noise(0.8f * p + Eigen::Vector3f(2.1f, 8.7f, 5.5f)) +
                               0.35f * smooth_noise(1.7f * p));
  albedo = mix(albedo, kVein, 0.65f * (1 - smooth_step(0.02f, 0.16f, ridge)));

  if (kind == SceneKind::textured) albedo = mix(albedo, kPrintInk, 0.9f * ink_at(p));

  Brdf brdf;
  brdf.albedo = albedo.cwiseMax(0.004f).cwiseMin(0.9f);
  const float gloss = kind == SceneKind::matte    ? 0.0f
                      : kind == SceneKind::glossy ? 1.0f
                                                  : smooth_step(-0.15f, 0.15f, std::sin(1.57f * s));
  brdf.specular = kGlossySpecular * gloss;
  brdf.alpha = kGlossyAlpha;
  return brdf;
}

}  // namespace sheen::capture::synthetic
