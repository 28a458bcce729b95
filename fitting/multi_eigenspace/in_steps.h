// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace sheen::fitting::multi_eigenspace {

/// A number in steps of 2^-bits. Whatever decides about groups is in such steps: they are far wider
/// than what other instructions leave in last digits, and sums of them are exact in any order, so
/// that groups are the same on every processor.
inline double in_steps(double value, int bits) {
  return std::ldexp(std::nearbyint(std::ldexp(value, bits)), -bits);
}

/// Inner products, which fit into 17 bits before the point: a thousand of them can be added.
inline constexpr int kProductBits = 26;
/// Mean squared errors, grey levels^2.
inline constexpr int kErrorBits = 16;
/// Gains in description length, pictures.
inline constexpr int kGainBits = 26;

}  // namespace sheen::fitting::multi_eigenspace
