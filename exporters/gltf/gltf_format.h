// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters::gltf {

/// Binary glTF without extensions of our own, y up: the mesh with a texture of mean radiance, or,
/// with --splats, Gaussian splats (KHR_gaussian_splatting).
extern const Format kFormat;

}  // namespace sheen::exporters::gltf
