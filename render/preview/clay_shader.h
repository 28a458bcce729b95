// SPDX-License-Identifier: MIT
#pragma once

#include "render/surface/patch_shader.h"

#include <memory>

namespace sheen::render {

/// Paints the mesh as unglazed clay, to show its shape; nothing to upload.
std::unique_ptr<PatchShader> make_clay_shader();

}  // namespace sheen::render
