// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <algorithm>

namespace sheen::fitting {

/// How models keep a number: the nearest half float, limited to what a half can hold. NaN stays.
inline Eigen::half stored_half(double value) {
  constexpr double largest = 65504.0;
  return Eigen::half(static_cast<float>(std::clamp(value, -largest, largest)));
}

/// Returns whether the stored bits changed.
inline bool replace(Eigen::half& place, Eigen::half value) {
  if (place.x == value.x) return false;
  place = value;
  return true;
}

/// Three neighbouring halves as r, g, b.
inline Eigen::Vector3f colour_at(const Eigen::half* rgb) {
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

}  // namespace sheen::fitting
