// SPDX-License-Identifier: MIT
#include "evaluation/study/handheld_path.h"

#include "core/geometry/tangent_frame.h"
#include "evaluation/study/random.h"

#include <cmath>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

constexpr float kTwoPi = 2.0f * std::numbers::pi_v<float>;

}  // namespace

Wobble::Wobble(std::uint64_t key) {
  Random random(key);
  for (std::size_t i = 0; i < frequency_.size(); ++i) {
    frequency_[i] = random.uniform(1.0f, 2.0f) * static_cast<float>(2 * i + 1);
    phase_[i] = random.uniform();
  }
}

float Wobble::at(float time) const {
  float sum = 0;
  float strength = 0.6f;
  for (std::size_t i = 0; i < frequency_.size(); ++i) {
    sum += strength * std::sin(kTwoPi * (frequency_[i] * time + phase_[i]));
    strength *= 0.5f;
  }
  return sum;
}

float with_dwell(float time, float phase) {
  constexpr float stops = 3.0f;
  constexpr float depth = 0.85f;  // the slowest speed is 1 - depth of the mean
  const float swing = depth / (kTwoPi * stops);
  const float here = std::sin(kTwoPi * (stops * time + phase));
  return time + swing * (here - std::sin(kTwoPi * phase));
}

HandheldArc::HandheldArc(std::uint64_t key)
    : wobble_along_(hash_of({key, 1})), wobble_across_(hash_of({key, 2})) {
  Random random(key);
  const core::TangentFrame frame = core::tangent_frame(random.on_sphere(0.75f));
  const float azimuth = random.uniform(0.0f, kTwoPi);
  middle_ = frame.normal;
  along_ = std::cos(azimuth) * frame.tangent + std::sin(azimuth) * frame.bitangent;
  across_ = middle_.cross(along_);
  span_ = random.uniform(1.7f, 2.4f);  // 97 to 138 degrees
  offset_ = random.uniform(-0.5f, 0.5f);
  dwell_phase_ = random.uniform();
}

Vector3f HandheldArc::at(float time) const {
  const float angle =
      span_ * (with_dwell(time, dwell_phase_) - 0.5f) + 0.03f * wobble_along_.at(time);
  const float offset = offset_ + 0.06f * wobble_across_.at(time);
  return (std::cos(angle) * middle_ + std::sin(angle) * along_ + offset * across_).normalized();
}

HandheldOrbit::HandheldOrbit(std::uint64_t key, float lowest, float highest, float rounds)
    : lowest_(lowest),
      highest_(highest),
      rounds_(rounds),
      wobble_azimuth_(hash_of({key, 1})),
      wobble_elevation_(hash_of({key, 2})) {
  Random random(key);
  start_ = random.uniform(0.0f, kTwoPi);
  dwell_phase_ = random.uniform();
}

Vector3f HandheldOrbit::at(float time) const {
  const float progress = with_dwell(time, dwell_phase_);
  const float azimuth =
      start_ + kTwoPi * rounds_ * progress + 0.06f * wobble_azimuth_.at(4.0f * time);
  const float elevation =
      lowest_ + (highest_ - lowest_) * progress + 0.09f * wobble_elevation_.at(4.0f * time);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace sheen::evaluation
