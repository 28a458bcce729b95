// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace sheen::fitting::spherical_harmonics {

/// Functions up to a degree: (degree + 1)^2.
constexpr std::size_t term_count(int degree) {
  const auto side = static_cast<std::size_t>(degree) + 1;
  return side * side;
}

inline constexpr int kMaxDegree = 3;

/// Y_00, the constant function.
inline constexpr double kY00 = 0.28209479177387814;

/// Real spherical harmonics of a unit direction (x, y, z) in the patch frame, orthonormal over the
/// sphere, ordered l = 0, 1, ..., m = -l ... l, without the Condon-Shortley sign: Y_1 is
/// proportional to (y, z, x). Sloan, "Stupid Spherical Harmonics Tricks" (2008), appendix A2.
/// kTerms is 4, 9 or 16.
template <std::size_t kTerms, typename Real>
constexpr std::array<Real, kTerms> basis(Real x, Real y, Real z) {
  static_assert(kTerms == 4 || kTerms == 9 || kTerms == 16);
  std::array<Real, kTerms> Y{};
  Y[0] = static_cast<Real>(kY00);
  constexpr auto k1 = static_cast<Real>(0.48860251190291992);
  Y[1] = k1 * y;
  Y[2] = k1 * z;
  Y[3] = k1 * x;
  if constexpr (kTerms >= 9) {
    constexpr auto k2 = static_cast<Real>(1.0925484305920792);
    Y[4] = k2 * x * y;
    Y[5] = k2 * y * z;
    Y[6] = static_cast<Real>(0.31539156525252005) * (Real{3} * z * z - Real{1});
    Y[7] = k2 * x * z;
    Y[8] = k2 / Real{2} * (x * x - y * y);
  }
  if constexpr (kTerms >= 16) {
    constexpr auto k33 = static_cast<Real>(0.59004358992664352);
    constexpr auto k32 = static_cast<Real>(1.4453057213202769);
    constexpr auto k31 = static_cast<Real>(0.45704579946446577);
    Y[9] = k33 * y * (Real{3} * x * x - y * y);
    Y[10] = Real{2} * k32 * x * y * z;
    Y[11] = k31 * y * (Real{5} * z * z - Real{1});
    Y[12] = static_cast<Real>(0.37317633259011546) * z * (Real{5} * z * z - Real{3});
    Y[13] = k31 * x * (Real{5} * z * z - Real{1});
    Y[14] = k32 * z * (x * x - y * y);
    Y[15] = k33 * x * (x * x - Real{3} * y * y);
  }
  return Y;
}

}  // namespace sheen::fitting::spherical_harmonics
