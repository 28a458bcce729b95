// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "fitting/detail/texture_solver.h"
#include "fitting/texture/surface_texture.h"

#include <span>

namespace sheen::fitting::detail {

/// Takes out of a texture what its observations do not ask for. Every chart is one colour, or
/// square tiles, each a colour that changes linearly along its rows and columns (four colours) or
/// four smaller tiles or, at last, its texels. A simpler form is taken where
///
///     sum over texels and channels of n r^2 / noise^2  <=  2 (numbers that it saves),
///
/// r its difference to the texture and n the weight of the texel's observations: Akaike's
/// criterion. A texel that is the mean of noise alone adds 1 to the left in the mean, so smooth
/// regions lose their noise. `weight` has an entry per texel, negative for those that no reading
/// touches, which stay; `noise` (> 0) is the deviation of one observation, of 255. The same on any
/// number of threads.
TexelCount simplify_texture(const core::Atlas& atlas, std::span<const float> weight, float noise,
                            int threads, Planes& texture);

}  // namespace sheen::fitting::detail
