// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/samples/sample.h"

#include <array>
#include <cstddef>

namespace sheen::fitting::iwls {

/// The basis 1, x, y, x^2, xy, y^2, cut after kTerms (eq. 6).
template <std::size_t kTerms>
constexpr std::array<double, kTerms> basis(double x, double y) {
  static_assert(kTerms == 1 || kTerms == 3 || kTerms == 6);
  if constexpr (kTerms == 1) {
    return {1.0};
  } else if constexpr (kTerms == 3) {
    return {1.0, x, y};
  } else {
    return {1.0, x, y, x * x, x * y, y * y};
  }
}

/// Three colour channels over one basis: [term][r, g, b].
template <std::size_t kTerms>
using Polynomial = std::array<double, 3 * kTerms>;

/// Value at (x, y), both in the polynomial's own coordinates.
template <std::size_t kTerms>
Rgb value_at(const Polynomial<kTerms>& p, double x, double y) {
  const auto b = basis<kTerms>(x, y);
  Rgb value{};
  for (std::size_t term = 0; term < kTerms; ++term) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      value[channel] += b[term] * p[3 * term + channel];
    }
  }
  return value;
}

/// The same function in other coordinates: with x = shift + scale * x', returns q with
/// q(x') = p(x). Exact, because a polynomial's space is closed under it.
template <std::size_t kTerms>
Polynomial<kTerms> re_expanded(const Polynomial<kTerms>& p, double shift_x, double shift_y,
                               double scale) {
  Polynomial<kTerms> q{};
  for (std::size_t i = 0; i < 3; ++i) {
    if constexpr (kTerms == 1) {
      q[i] = p[i];
    } else if constexpr (kTerms == 3) {
      q[i] = p[i] + shift_x * p[3 + i] + shift_y * p[6 + i];
      q[3 + i] = scale * p[3 + i];
      q[6 + i] = scale * p[6 + i];
    } else {
      // Taylor expansion about the shifted origin.
      const double xx = p[9 + i], xy = p[12 + i], yy = p[15 + i];
      q[i] = p[i] + shift_x * (p[3 + i] + shift_x * xx + shift_y * xy) +
             shift_y * (p[6 + i] + shift_y * yy);
      q[3 + i] = scale * (p[3 + i] + 2.0 * shift_x * xx + shift_y * xy);
      q[6 + i] = scale * (p[6 + i] + 2.0 * shift_y * yy + shift_x * xy);
      q[9 + i] = scale * scale * xx;
      q[12 + i] = scale * scale * xy;
      q[15 + i] = scale * scale * yy;
    }
  }
  return q;
}

}  // namespace sheen::fitting::iwls
