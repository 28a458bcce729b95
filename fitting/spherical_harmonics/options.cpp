// SPDX-License-Identifier: MIT
#include "fitting/spherical_harmonics/options.h"

#include "fitting/spherical_harmonics/basis.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting::spherical_harmonics {

void Options::check() const {
  if (degree < 1 || degree > kMaxDegree) {
    throw std::invalid_argument("degree is " + std::to_string(degree) + ", allowed are 1, 2 and 3");
  }
  if (!(ridge > 0.0 && ridge <= 1000.0)) {
    throw std::invalid_argument("ridge is " + std::to_string(ridge) +
                                ", it must be above 0 and at most 1000");
  }
}

OptionTable option_table(Options& options) {
  return {number_option("degree", options.degree, 1, kMaxDegree,
                        "Of the harmonics: 4, 9 or 16 terms per patch"),
          number_option("ridge", options.ridge, 1e-6, 1000.0,
                        "Pull of all terms but the constant towards zero, in samples")};
}

}  // namespace sheen::fitting::spherical_harmonics
