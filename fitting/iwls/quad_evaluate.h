// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/lanes.h"
#include "fitting/iwls/quad_kernels.h"
#include "fitting/iwls/wendland_lanes.h"

#include <cstddef>

namespace sheen::fitting::iwls::SHEEN_LANES {

/// Numerator and denominator of eq. 7, four centres at a time.
template <std::size_t kTerms>
void evaluate(const QuadCenters& centers, const std::uint16_t* coefficients, float u, float v,
              float* sums) {
  using L = Lanes<float>;
  const auto term = [&](std::size_t i) __attribute__((always_inline)) {
    Halves halves;
    __builtin_memcpy(&halves, coefficients + kLanes * i, sizeof(halves));
    return from_halves(halves);
  };
  L sum[4] = {};
  for (std::size_t quad = 0; quad < centers.quad_count;
       ++quad, coefficients += kLanes * 3 * kTerms) {
    const L x = (u - load(centers.u + kLanes * quad)) * centers.inverse_radius;
    const L y = (v - load(centers.v + kLanes * quad)) * centers.inverse_radius;
    const L distance2 = x * x + y * y;
    const LaneMask<float> covered = distance2 < 1;
    if (bits_of(covered) == 0) continue;
    const L theta = weights<float>(distance2, covered);
    for (std::size_t i = 0; i < 3; ++i) {
      L value = term(i);
      if constexpr (kTerms >= 3) value += x * term(3 + i) + y * term(6 + i);
      if constexpr (kTerms >= 6) {
        value += x * x * term(9 + i) + x * y * term(12 + i) + y * y * term(15 + i);
      }
      sum[i] += theta * value;
    }
    sum[3] += theta;
  }
  for (std::size_t i = 0; i < 4; ++i) sums[i] = (sum[i][0] + sum[i][1]) + (sum[i][2] + sum[i][3]);
}

}  // namespace sheen::fitting::iwls::SHEEN_LANES
