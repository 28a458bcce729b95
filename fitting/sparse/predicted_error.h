// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

#include <span>

namespace sheen::fitting::sparse {

/// How wrong a patch is likely to be towards `uv`, in units of sRGB (only its order is meant
/// seriously): root mean square of what the four nearest samples were off when predicted without
/// them + distance to the nearest sample x spread of the colours + half the disagreement between
/// `shown`, what the model says, and a blend of the three nearest samples. Finite and >= 0; at
/// least one sample.
float predicted_error(const SampleStore& samples, const SamplePool& pool, float spread,
                      const Eigen::Vector2f& uv, const Eigen::Vector3f& shown);

/// Standard deviation of the colours, root mean square over the channels.
float colour_spread(std::span<const DirectedColour> samples);

}  // namespace sheen::fitting::sparse
