// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace sheen::core {

/// The kinds of lenses. Each is one file NAME.lens beside this one, which defines
/// `distort_NAME(k, x, y, u, v)`: the ideal position (x, y) in the plane z = 1 -> the position
/// (u, v) that the lens makes of it in the same plane, by eight coefficients k. The file is written
/// in the common subset of C++ and GLSL, so that projection, derivatives, calibration, the inner
/// loops of sampling and the shaders all have the same lens. Another kind is another file, an
/// enumerator and a line in kLenses and in `distort` below.
enum class LensKind { rational, fisheye };

struct LensTraits {
  LensKind kind;
  std::string_view name;  ///< of its file, and in reports
  double widest_radius;   ///< in the plane z = 1; rays further from the axis are not modelled
};
inline constexpr std::array kLenses{
    LensTraits{LensKind::rational, "rational", 6.0},  // tan(80.5 degrees)
    LensTraits{LensKind::fisheye, "fisheye", 57.0},   // tan(89 degrees)
};

constexpr const LensTraits& traits_of(LensKind kind) {
  return kLenses[static_cast<std::size_t>(kind)];
}

/// Text of a lens file, for shaders; "rational.lens". Lives as long as the program.
std::string_view lens_text(std::string_view name);

namespace lens {

using std::atan;
using std::sqrt;

#define LENS_FUNCTION template <typename Real, typename Coefficient> inline
#define LENS_ARRAY(name) const Coefficient* name
#define LENS_OUT(name) Real& name
#include "core/geometry/lens/fisheye.lens"
#include "core/geometry/lens/rational.lens"
#undef LENS_FUNCTION
#undef LENS_ARRAY
#undef LENS_OUT

}  // namespace lens

/// By the kind's own function. Numbers are floating-point ones or carry derivatives.
template <typename Real, typename Coefficient>
void distort(LensKind kind, const Coefficient* k, const Real& x, const Real& y, Real& u, Real& v) {
  switch (kind) {
    case LensKind::rational:
      return lens::distort_rational(k, x, y, u, v);
    case LensKind::fisheye:
      return lens::distort_fisheye(k, x, y, u, v);
  }
}

}  // namespace sheen::core
