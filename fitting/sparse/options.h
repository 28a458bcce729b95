// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

#include <optional>

namespace sheen::fitting::sparse {

/// Tolerance as long as the camera's noise is not known: twice the noise of a good camera.
inline constexpr float kToleranceOfUnknownNoise = 0.02f;

/// How sparse patches are grown.
struct Options {
  /// Error that nobody minds, sRGB, in (0, 1): below it no term is worth its bytes. Nothing: twice
  /// the camera's noise, estimated from samples of nearly the same direction.
  std::optional<float> tolerance{};
  /// Price of a stored number, in halves of log n (1 is Schwarz's criterion), in [0, 10]: more is
  /// leaner.
  float criterion_weight = 0.3f;
  /// Samples kept per patch, in [8, 128]; beyond that the closest directions become one.
  int max_samples = 128;

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

/// What users choose of it.
OptionTable option_table(Options& options);

}  // namespace sheen::fitting::sparse
