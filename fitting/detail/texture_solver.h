// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/detail/surface_texels.h"
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
/// larger lambda. What colours at the vertices of `mesh`, interpolated across its triangles, could
/// add to the texture is left alone: what pixels differ by so smoothly is how the surface's colour
/// changes with direction, which the texture has no part in. Texels without pixels stay. `texels`
/// are rows of `width`, those at the border without pixels; `surface` says where they lie. The same
/// on any number of threads.
void solve_texture(std::span<const TexelSums> texels, std::size_t width, const core::Mesh& mesh,
                   const SurfaceTexels& surface, int threads, Planes& texture);

}  // namespace sheen::fitting::detail
