// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace sheen::fitting {

using Rgb = std::array<double, 3>;

/// One sample of a batch in the precision of the fits.
struct Sample {
  double u, v;  ///< on the closed unit disc
  Rgb rgb;
};

/// Sample `idx`, its direction put on the rim when it lies outside the disc. Nothing when any of
/// its numbers is not finite or far beyond what a colour can be: such a sample must never enter a
/// running sum.
inline std::optional<Sample> usable_sample(const core::SampleBatch& batch, std::size_t idx) {
  Sample sample{static_cast<double>(batch.u[idx]),
                static_cast<double>(batch.v[idx]),
                {static_cast<double>(batch.r[idx]), static_cast<double>(batch.g[idx]),
                 static_cast<double>(batch.b[idx])}};
  const double total = std::abs(sample.u) + std::abs(sample.v) + std::abs(sample.rgb[0]) +
                       std::abs(sample.rgb[1]) + std::abs(sample.rgb[2]);
  constexpr double largest = 1e4;  // a half holds 65504; NaN fails every comparison
  if (!(total < largest)) return std::nullopt;
  const double radius2 = sample.u * sample.u + sample.v * sample.v;
  if (radius2 > 1.0) {
    const double radius = std::sqrt(radius2);
    sample.u /= radius;
    sample.v /= radius;
  }
  return sample;
}

/// Running sum of the colours of one patch, in all directions alike.
struct PatchTotal {
  double count = 0;
  Rgb sum{};

  void add(const Rgb& rgb) {
    count += 1;
    for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += rgb[channel];
  }
  /// count > 0.
  [[nodiscard]] Rgb mean() const { return {sum[0] / count, sum[1] / count, sum[2] / count}; }
};

}  // namespace sheen::fitting
