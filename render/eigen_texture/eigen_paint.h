// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "render/surface/patch_shader.h"

#include <memory>

namespace sheen::render::eigen_texture {

/// Paints a mesh with an eigen-texture whose sums are taken by OpenGL, in floats: at the pixels
/// (screen space) where the image has fewer of them than the texture has texels, else at the texels
/// (texture space). The two differ where sums leave what an image holds: screen space clamps them
/// after reading between texels. `gl` and light field outlive it. Throws core::Error (run_failed)
/// when the driver cannot hold the bases.
std::unique_ptr<PatchShader> make_eigen_paint(
    const gl::Functions& gl, const fitting::eigen_texture::EigenTexture& light_field);

}  // namespace sheen::render::eigen_texture
