// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/eigen_texture/texel_reader.h"

#include <array>
#include <span>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// Sweeps of expectation maximisation that settle the coefficients.
inline constexpr int kSweeps = 12;

/// Bases and coefficients from all views (by slot each). The coefficients come from probabilistic
/// PCA of a part of the texels, evenly chosen; then every texel is regressed on them over the views
/// that saw it. Of more than kMostFactorised views the PCA takes every second, third, ...; those
/// between are explained by its bases. `mean` is the stored mean of every used texel. The same on
/// any number of threads.
std::array<Channel, 3> fit_bases(std::span<const std::vector<SeenTexel>> views,
                                 std::span<const Texel> mean, std::size_t bases, int sweeps,
                                 int threads);

/// Memory and time of the PCA are bounded by it.
inline constexpr std::size_t kMostFactorised = 512;

}  // namespace sheen::fitting::eigen_texture
