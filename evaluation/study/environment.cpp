// SPDX-License-Identifier: MIT
#include "evaluation/study/environment.h"

#include "core/geometry/tangent_frame.h"
#include "evaluation/study/random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

constexpr float kDegree = std::numbers::pi_v<float> / 180.0f;
const float kGoldenAngle = std::numbers::pi_v<float> * (3.0f - std::sqrt(5.0f));

// Point `idx` of `count` on the cap with z >= lowest round +z: a spiral of equal solid angles.
Vector3f spiral(std::size_t idx, std::size_t count, float lowest) {
  const float part = (static_cast<float>(idx) + 0.5f) / static_cast<float>(count);
  const float z = 1.0f - (1.0f - lowest) * part;
  const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float azimuth = kGoldenAngle * static_cast<float>(idx);
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

void add_lamp(Environment& environment, const Vector3f& towards, float radius,
              const Vector3f& radiance, std::size_t count) {
  const core::TangentFrame frame = core::tangent_frame(towards);
  const float solid_angle = 2.0f * std::numbers::pi_v<float> * (1.0f - std::cos(radius));
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3f local = spiral(i, count, std::cos(radius));
    environment.direction.push_back(frame.in_object(local));
    environment.power.push_back(radiance * (solid_angle / static_cast<float>(count)));
  }
}

// Adds light from everywhere; `radiance` maps a direction to RGB.
template <typename Radiance>
void add_sphere(Environment& environment, std::size_t count, const Radiance& radiance) {
  const float solid_angle = 4.0f * std::numbers::pi_v<float> / static_cast<float>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3f direction = spiral(i, count, -1.0f);
    environment.direction.push_back(direction);
    environment.power.push_back(radiance(direction) * solid_angle);
  }
}

Vector3f towards(float azimuth_degree, float elevation_degree) {
  const float azimuth = azimuth_degree * kDegree;
  const float elevation = elevation_degree * kDegree;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

Vector3f sky(const Vector3f& direction) {
  const Vector3f ground(0.10f, 0.09f, 0.08f);
  const Vector3f zenith(0.26f, 0.30f, 0.36f);
  return ground + (zenith - ground) * (0.5f + 0.5f * direction.z());
}

// Smooth noise in [-1, 1]: random values on a lattice, interpolated with zero slope at its points.
float lattice_noise(const Vector3f& at, std::uint64_t key) {
  const Eigen::Array3f low = at.array().floor();
  const Eigen::Array3f part = at.array() - low;
  const Eigen::Array3f weight = part * part * (3.0f - 2.0f * part);
  float sum = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    float product = 1;
    std::uint64_t hash = key;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = ((corner >> axis) & 1u) != 0;
      product *= upper ? weight[axis] : 1.0f - weight[axis];
      const auto cell = static_cast<std::int64_t>(low[axis]) + (upper ? 1 : 0);
      hash = hash_of({hash, static_cast<std::uint64_t>(cell)});
    }
    sum += product * Random(hash).uniform(-1.0f, 1.0f);
  }
  return sum;
}

Vector3f busy_wall(const Vector3f& direction) {
  // Noise: each octave half the size and two thirds the strength of the last.
  Vector3f radiance(0.30f, 0.28f, 0.25f);
  float frequency = 2.0f;
  float strength = 0.6f;
  for (std::uint64_t octave = 0; octave < 4; ++octave) {
    const float noise = lattice_noise(frequency * direction, octave);
    radiance *= 1.0f + strength * noise;
    frequency *= 2.0f;
    strength *= 0.67f;
  }
  // Window: bright stripes of 12 degrees, half of it invalid.
  const float azimuth = std::atan2(direction.y(), direction.x()) / kDegree;
  const float elevation = std::asin(direction.z()) / kDegree;
  const bool in_window = std::abs(azimuth) < 50.0f && elevation > 5.0f && elevation < 65.0f;
  const bool open = std::fmod(azimuth + 60.0f, 12.0f) < 6.0f;
  if (in_window && open) radiance += Vector3f(1.9f, 2.0f, 2.2f);
  return radiance;
}

}  // namespace

Environment studio_environment() {
  Environment environment;
  constexpr std::size_t per_lamp = 64;
  add_lamp(environment, towards(20, 55), 15 * kDegree, {5.9f, 5.5f, 4.8f}, per_lamp);
  add_lamp(environment, towards(110, 30), 10 * kDegree, {6.8f, 6.8f, 6.8f}, per_lamp);
  add_lamp(environment, towards(185, 65), 8 * kDegree, {8.5f, 8.2f, 7.5f}, per_lamp);
  add_lamp(environment, towards(250, 10), 12 * kDegree, {4.7f, 5.2f, 6.0f}, per_lamp);
  add_lamp(environment, towards(310, 40), 6 * kDegree, {10.4f, 9.6f, 8.6f}, per_lamp);
  add_sphere(environment, 1600, sky);
  return environment;
}

Environment busy_environment() {
  Environment environment;
  add_sphere(environment, 5000, busy_wall);
  Random random(hash_of({0xb05e}));
  for (int lamp = 0; lamp < 30; ++lamp) {
    const Vector3f direction = random.on_sphere(-0.3f, 0.95f);
    const float radius = random.uniform(2.0f, 4.0f) * kDegree;
    const Vector3f colour(random.uniform(0.7f, 1.0f), random.uniform(0.7f, 1.0f),
                          random.uniform(0.5f, 1.0f));
    add_lamp(environment, direction, radius, random.uniform(3.0f, 9.0f) * colour, 7);
  }
  return environment;
}

}  // namespace sheen::evaluation
