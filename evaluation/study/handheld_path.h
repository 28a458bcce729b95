// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace sheen::evaluation {

/// Slow sum of three sines with random phases: how a hand wavers. Amplitude about 1.
class Wobble {
 public:
  explicit Wobble(std::uint64_t key);
  [[nodiscard]] float at(float time) const;

 private:
  std::array<float, 3> frequency_{};  // cycles per unit of time
  std::array<float, 3> phase_{};
};

/// Time that runs unevenly: slows down three times per unit, almost to a stop. Maps [0, 1] onto
/// itself and never runs backwards.
float with_dwell(float time, float phase);

/// A sweep of a handheld camera across a hemisphere: part of a circle near a great circle, with
/// wobble and dwell.
class HandheldArc {
 public:
  explicit HandheldArc(std::uint64_t key);

  /// Unit direction at `time` in [0, 1]; may dip below z = 0.
  [[nodiscard]] Eigen::Vector3f at(float time) const;

 private:
  Eigen::Vector3f middle_, along_, across_;  // orthonormal
  float span_, offset_, dwell_phase_;
  Wobble wobble_along_, wobble_across_;
};

/// Walk of a handheld camera around an object: several rounds at rising elevation.
class HandheldOrbit {
 public:
  /// Elevations in radians.
  HandheldOrbit(std::uint64_t key, float lowest, float highest, float rounds);

  /// Unit direction from the object to the camera at `time` in [0, 1], z up.
  [[nodiscard]] Eigen::Vector3f at(float time) const;

 private:
  float lowest_, highest_, rounds_, start_, dwell_phase_;
  Wobble wobble_azimuth_, wobble_elevation_;
};

}  // namespace sheen::evaluation
