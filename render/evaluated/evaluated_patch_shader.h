// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "render/surface/patch_shader.h"

#include <memory>

namespace sheen::render::evaluated {

/// For any light field: calls LightField::evaluate for every vertex and view on the CPU, in
/// parallel, and sends 8 bytes per patch. The image is that of a shader of its own; the time per
/// view is not. All must outlive it.
std::unique_ptr<PatchShader> make_patch_shader(const gl::Functions& gl, const core::Mesh& mesh,
                                               const fitting::PatchLightField& light_field,
                                               int threads);

}  // namespace sheen::render::evaluated
