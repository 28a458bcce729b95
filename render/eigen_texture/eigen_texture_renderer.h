// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/eigen_texture/eigen_texture.h"
#include "render/context/context.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Draws the mesh with the texture towards the eye, blended anew for every view: by OpenGL
/// (eigen_paint.h), or on the CPU where OpenGL is a program, too. Context, mesh and light field
/// outlive it.
std::unique_ptr<Renderer> make_eigen_texture_renderer(
    Context& context, const core::Mesh& mesh,
    const fitting::eigen_texture::EigenTexture& light_field, int threads);

/// Blends on the CPU, with the quickest kernel (blend_kernels.h).
std::unique_ptr<Renderer> make_cpu_eigen_texture_renderer(
    Context& context, const core::Mesh& mesh,
    const fitting::eigen_texture::EigenTexture& light_field, int threads);

}  // namespace sheen::render
