// SPDX-License-Identifier: MIT
#pragma once

namespace sheen::fitting::spherical_harmonics {

/// How spherical harmonics are fitted to the samples of a patch.
struct Options {
  int degree = 3;  ///< 1, 2 or 3: 4, 9 or 16 terms
  /// Pull of all terms but the constant towards zero, in units of samples; > 0, <= 1000.
  double ridge = 0.01;
  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

}  // namespace sheen::fitting::spherical_harmonics
