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

}  // namespace sheen::fitting::spherical_harmonics
