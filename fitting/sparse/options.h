// SPDX-License-Identifier: MIT
#pragma once

namespace sheen::fitting::sparse {

/// How sparse patches are grown.
struct Options {
  /// Error that nobody minds, sRGB, in (0, 1): below it no term is worth its bytes.
  float tolerance = 0.02f;
  /// Price of a stored number, in halves of log n (1 is Schwarz's criterion), in [0, 10]: more is
  /// leaner.
  float economy = 0.3f;
  /// Samples kept per patch, in [8, 128]; beyond that the closest two directions become one.
  int max_samples = 96;

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

}  // namespace sheen::fitting::sparse
