// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace sheen::fitting::sparse {

/// Weights against outliers: 1 up to a threshold t of five robust standard deviations (1.4826 x the
/// median, never less than `floor`), beyond it (t / r)^2. Turns residual sizes (>= 0) into factors
/// in (0, 1], in place. Returns whether any is below 1. At most kMaxStoredSamples values.
///
/// Huber's own weight is t / r and bounds what an outlier can do; squared, its pull fades.
bool robust_factors(std::span<float> residuals, float floor);

}  // namespace sheen::fitting::sparse
