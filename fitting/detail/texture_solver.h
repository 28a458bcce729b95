// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/texel_sums.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// A number for every texel, one plane per channel (RGB, 0 to 255).
using Planes = std::array<std::vector<float>, 3>;

/// Weighted mean of the pixels around every texel; 0 where there are none.
Planes mean_texture(std::span<const TexelSums> texels);

/// Improves a texture to the one that explains the pixels best: minimises
///
///     sum_p q_p |b_p . t - I_p|^2 + lambda sum |t - t_0|^2
///
/// with t_0 what it is given, by conjugate gradients; a few steps are enough and as good as a
/// larger lambda. Texels without pixels stay. `texels` are rows of `width`, those at the border
/// without pixels. The same on any number of threads.
void solve_texture(std::span<const TexelSums> texels, std::size_t width, int threads,
                   Planes& texture);

}  // namespace sheen::fitting::detail
