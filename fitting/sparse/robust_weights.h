// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace sheen::fitting::sparse {

/// Weights against outliers: 1 up to a threshold t of five robust standard deviations (1.4826 x the
/// median, never less than `floor`), beyond it (t / r)^2. Turns residual sizes (>= 0) into factors
/// in (0, 1], in place. Returns whether any is below 1. At most kMaxStoredSamples values.
///
/// Huber's own weight is t / r and bounds what an outlier can do; squared, its pull fades. On the
/// study's scene at 96 samples one pass with t at five deviations costs 0.10 dB on clean data and
/// 1.5 dB with 2 % of outliers; Huber's weight with three deviations costs 0.08 and 3.0 dB, no
/// weights 0 and 9.6 dB.
bool robust_factors(std::span<float> residuals, float floor);

}  // namespace sheen::fitting::sparse
