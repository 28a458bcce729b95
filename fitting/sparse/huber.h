// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace sheen::fitting::sparse {

/// Huber's weights with a threshold of three robust standard deviations (1.4826 x the median),
/// never less than 3 x `floor`. Turns residual sizes (>= 0) into factors in (0, 1], in place.
/// Returns whether any is below 1. At most kMaxStoredSamples values.
bool huber_factors(std::span<float> residuals, float floor);

}  // namespace sheen::fitting::sparse
