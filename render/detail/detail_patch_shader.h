// SPDX-License-Identifier: MIT
#pragma once

#include "render/surface/patch_shader.h"

#include <memory>

namespace sheen::render::detail {

/// For light fields whose representation is "detail": the shader of sparse patches, and a texture.
std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl,
                                               const fitting::PatchLightField& light_field);

}  // namespace sheen::render::detail
