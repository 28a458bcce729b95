// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

namespace sheen::evaluation {

/// Mixes integers into a key (finaliser of SplitMix64 after each): the same on every machine.
constexpr std::uint64_t hash_of(std::initializer_list<std::uint64_t> parts) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  for (const std::uint64_t part : parts) {
    hash = (hash ^ part) + 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
    hash ^= hash >> 31;
  }
  return hash;
}

/// PCG32 (O'Neill 2014, XSH-RR) and the few distributions the study needs. The standard library's
/// distributions differ between implementations; these do not.
class Random {
 public:
  explicit Random(std::uint64_t key) : state_(key) { bits(); }

  std::uint32_t bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + 1442695040888963407u;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> turn) | (shifted << ((32 - turn) & 31));
  }

  /// [0, 1) in steps of 2^-24: every value is a float.
  float uniform() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }

  /// Standard normal (Box and Muller, one of the pair).
  float normal() {
    const float radius = std::sqrt(-2.0f * std::log(1.0f - uniform()));
    return radius * std::cos(2.0f * std::numbers::pi_v<float> * uniform());
  }

  /// Uniform on the part of the unit sphere with z in [low, high).
  Eigen::Vector3f on_sphere(float low = -1.0f, float high = 1.0f) {
    const float z = uniform(low, high);
    const float azimuth = 2.0f * std::numbers::pi_v<float> * uniform();
    const float radius = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
  }

 private:
  std::uint64_t state_;
};

}  // namespace sheen::evaluation
