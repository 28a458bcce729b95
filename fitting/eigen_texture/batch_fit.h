// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/eigen_texture/texel_reader.h"

#include <array>
#include <span>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// Bases and coefficients from all views (by slot each). The coefficients come from probabilistic
/// PCA of a part of the texels, evenly chosen; then every texel is regressed on them over the views
/// that saw it. `mean` is the stored mean of every used texel. The same on any number of threads.
std::array<Channel, 3> fit_bases(std::span<const std::vector<SeenTexel>> views,
                                 std::span<const Texel> mean, std::size_t bases, int threads);

}  // namespace sheen::fitting::eigen_texture
