// SPDX-License-Identifier: MIT
#pragma once

namespace sheen::fitting::iwls {

/// Ridge of eq. 8, in units of samples at the centre (theta = 1). Chosen on synthetic lumispheres,
/// scattered and along arcs (docs/algorithm.md, section 8).
struct Ridge {
  /// Pull of the value towards its prior: decides only where there is hardly any sample.
  double value = 0.1;
  /// Pull of slopes and curvatures towards zero, per unit of sum theta: bounds what the tiny spread
  /// across a collinear sweep can do, however many samples the sweep brings. Ten times this costs
  /// 13 % on 256 scattered samples.
  double relative = 0.005;
  /// The same, absolute: fades as samples arrive. Without it the first samples tip over.
  double absolute = 0.03;
};

/// How systems become polynomials.
struct FitRule {
  bool faithful = false;      ///< no ridge; systems without a unique solution fall to a constant
  bool choose_order = false;  ///< use only as many terms as the samples carry
  Ridge ridge{};
};

/// Samples per term that a leading block needs before `choose_order` uses it: the ridge carries the
/// rest (with two per term the error at 8 to 16 samples rises by 2 to 4 %).
inline constexpr double kSamplesPerTerm = 1.0;

/// Smallest pivot of the system scaled to unit diagonal that counts as regular without a ridge. The
/// pivot is about (spread / distance from the node)^2: below this the samples lie on a line or a
/// point.
inline constexpr double kSmallestPivot = 1e-6;

}  // namespace sheen::fitting::iwls
