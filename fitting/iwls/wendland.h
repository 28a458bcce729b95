// SPDX-License-Identifier: MIT
#pragma once

namespace sheen::fitting::iwls {

/// Wendland's C2 function of distance over support radius, d / h >= 0: 1 at the centre, 0 with zero
/// slope and curvature at the rim, 0 beyond (eq. 5).
template <typename Real>
constexpr Real wendland(Real relative_distance) {
  if (relative_distance >= Real{1}) return Real{0};
  const Real rest = Real{1} - relative_distance;
  const Real rest2 = rest * rest;
  return rest2 * rest2 * (Real{4} * relative_distance + Real{1});
}

}  // namespace sheen::fitting::iwls
