// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/view_dependent_texture/view_texture.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Draws photographs onto a mesh on the CPU. At every pixel those photographs count that see the
/// point, the nearest by angle first: with the angles p_i of the k best and p of the next one,
/// w_i = (1 - p_i / p) / p_i, faded out towards jumps of depth and the borders of a photograph.
/// Where none sees the point, the mean colours of the vertices, not supported. The same image on
/// any number of threads. Mesh and light field outlive it.
std::unique_ptr<Renderer> make_view_texture_renderer(
    const core::Mesh& mesh, const fitting::view_dependent_texture::ViewTexture& texture,
    int threads);

}  // namespace sheen::render
