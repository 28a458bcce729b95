// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/eigen_texture/eigen_texture.h"
#include "render/context/context.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Blends the texture anew on the CPU for every view, with the quickest kernel
/// (blend_kernels.h), and draws the mesh with it. Context, mesh and light field outlive it.
std::unique_ptr<Renderer> make_eigen_texture_renderer(
    Context& context, const core::Mesh& mesh,
    const fitting::eigen_texture::EigenTexture& light_field, int threads);

}  // namespace sheen::render
