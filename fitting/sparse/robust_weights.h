// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/sample_store.h"

#include <cstddef>
#include <span>

namespace sheen::fitting::sparse {

/// Residual size above which a sample is suspected to be an outlier: five robust standard
/// deviations (1.4826 x the median), never less than five times `floor`. 1 to kMaxStoredSamples
/// sizes (>= 0).
float suspect_threshold(std::span<const float> residuals, float floor);

/// Weight of a suspected sample: 1 up to the threshold t, beyond it (t / r)^2. Huber's own weight
/// is t / r and bounds what an outlier can do; squared, its pull fades.
float robust_factor(float residual, float threshold);

/// Median residual of the seven samples nearest in direction, the sample itself left out; 0 when it
/// is alone.
float residual_around(std::span<const DirectedColour> samples, std::span<const float> residuals,
                      std::size_t sample_idx);

}  // namespace sheen::fitting::sparse
