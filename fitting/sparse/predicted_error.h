// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/patch_model.h"
#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

#include <span>

namespace sheen::fitting::sparse {

/// How wrong a patch is likely to be towards `uv`, in units of sRGB (only its order is meant
/// seriously): root mean squared leave-one-out residual of the four nearest samples + distance
/// to the nearest sample x spread of the colours + half the disagreement between the model and a
/// blend of the three nearest samples. Solves the patch's regression anew at every call. Finite and
/// >= 0; at least one sample, at most kMaxStoredSamples.
float predicted_error(const PatchModel& model, std::span<const DirectedColour> samples,
                      const Eigen::Vector2f& uv);

}  // namespace sheen::fitting::sparse
