// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace sheen::fitting::detail {

/// The mean of colours that views showed at a place, weighted with the squared cosine q between
/// normal and view, because what is seen obliquely is seen unsharply. Sums of integers, so that
/// they do not depend on the order of the views.
struct alignas(16) WeightedMean {
  std::uint32_t weight = 0;               ///< sum of q, in 64ths
  std::array<std::uint32_t, 3> colour{};  ///< sum of q times the colour, RGB, in 1020ths

  /// Adds a colour (0 to 255 each). Takes no more when its sums could overflow: after 65,000 views
  /// that see the place frontally.
  void add(const std::array<float, 3>& rgb, float squared_cosine) {
    if (weight > kFull) return;
    const auto q = static_cast<std::uint32_t>(squared_cosine * kWeightUnits + 0.5f);
    weight += q;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      colour[channel] += q * static_cast<std::uint32_t>(rgb[channel] * kColourUnits + 0.5f);
    }
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
  static constexpr std::uint32_t kFull = 0xffffffffU / 1020U - 64U;
};
static_assert(sizeof(WeightedMean) == 16);

}  // namespace sheen::fitting::detail
