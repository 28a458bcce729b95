// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/lanes.h"

namespace sheen::fitting::iwls::SHEEN_LANES {

/// Wendland's function (5) of the squared relative distance, 0 in lanes that are not `covered`.
template <typename Real>
SHEEN_INLINE Lanes<Real> weights(Lanes<Real> distance2, LaneMask<Real> covered) {
  const Lanes<Real> d = square_root(covered ? distance2 : Lanes<Real>{});
  const Lanes<Real> rest = 1 - d;
  const Lanes<Real> rest2 = rest * rest;
  const Lanes<Real> theta = rest2 * rest2 * (4 * d + 1);
  return covered ? theta : Lanes<Real>{};
}

}  // namespace sheen::fitting::iwls::SHEEN_LANES
