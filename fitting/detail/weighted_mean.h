// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/four.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace sheen::fitting::detail {

/// The mean of colours that views showed at a place, weighted with the squared cosine q between
/// normal and view, because what is seen obliquely is seen unsharply. Sums of integers, so that
/// they do not depend on the order of the views.
struct alignas(16) WeightedMean {
  std::uint32_t weight = 0;               ///< sum of q, in 64ths
  std::array<std::uint32_t, 3> colour{};  ///< sum of q times the colour, RGB, in 1020ths

  /// Adds a colour: 1, R, G, B, 0 to 255 each. Takes no more when its sums could reach 2^31: after
  /// 32,000 views that see the place frontally.
  SHEEN_INLINE void add(const Four& one_rgb, float squared_cosine) {
    if (weight > kFull) return;
    const FourCounts units =
        as_counts(one_rgb * Four{1, kColourUnits, kColourUnits, kColourUnits} + 0.5f);
    const auto q = static_cast<std::uint32_t>(squared_cosine * kWeightUnits + 0.5f);
    FourCounts sums;
    std::memcpy(&sums, this, sizeof(sums));
    sums += q * units;
    std::memcpy(static_cast<void*>(this), &sums, sizeof(sums));
  }

  /// A number without meaning, then the mean, 0 to 255; weight > 0.
  [[nodiscard]] SHEEN_INLINE Four any_rgb() const {
    FourInts sums;
    std::memcpy(&sums, this, sizeof(sums));
    const Four weighted = as_four(sums);
    return weighted * (1.0f / (kColourUnits * weighted[0]));
  }
  /// Sum of q.
  [[nodiscard]] float observations() const { return static_cast<float>(weight) / kWeightUnits; }
  /// The mean, 0 to 255; weight > 0.
  [[nodiscard]] float mean(std::size_t channel) const {
    return static_cast<float>(colour[channel]) / (kColourUnits * static_cast<float>(weight));
  }
  /// The mean, 0 to 1; black where there is nothing.
  [[nodiscard]] Eigen::Vector3f mean() const {
    if (weight == 0) return Eigen::Vector3f::Zero();
    return Eigen::Vector3f(mean(0), mean(1), mean(2)) / 255.0f;
  }

 private:
  static constexpr float kWeightUnits = 64.0f;
  static constexpr float kColourUnits = 4.0f;  // of a step of the image
  static constexpr std::uint32_t kFull = 0x7fffffffU / 1020U - 64U;
};
static_assert(sizeof(WeightedMean) == 16);

}  // namespace sheen::fitting::detail
