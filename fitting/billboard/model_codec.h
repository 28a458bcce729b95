// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::billboard {

/// The mean colours as representation `mean` keeps them, and: parameters directions, size,
/// fieldOfView (degrees), blending ("blended", "nearest"), centre and radius (metres), cacheMb;
/// arrays crops, unsigned 32-bit [frame][left, top, width, height, bytes of the JPEG, of the PNG],
/// six zeros for a frame that shows nothing, and images, JPEG and PNG of every frame (FrameImage),
/// left out where there is none.
ModelPart encode_model(const LightField& light_field);
/// Throws ModelFault for anything that `encode_model` does not write. Images are only looked at for
/// their size.
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::billboard
