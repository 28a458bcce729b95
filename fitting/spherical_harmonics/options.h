// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

namespace sheen::fitting::spherical_harmonics {

/// How spherical harmonics are fitted to the samples of a patch.
struct Options {
  int degree = 3;  ///< 1, 2 or 3: 4, 9 or 16 terms
  /// Pull of all terms but the constant towards zero, in units of samples; > 0, <= 1000. Chosen so
  /// that this yardstick is at its best: on synthetic lumispheres the error of degree 3 with 64
  /// samples is .0874 at .01, .0850 at .3 and .0848 at 1 when they are scattered, .150, .114 and
  /// .108 along arcs; stronger pulls lose to it where samples abound.
  double ridge = 0.3;
  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

/// What users choose of it.
OptionTable option_table(Options& options);

}  // namespace sheen::fitting::spherical_harmonics
