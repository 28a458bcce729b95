// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::depth_quads {

/// The mean colours as representation `mean` keeps them, the photographs (kept_views/view_codec.h),
/// and: parameters spacing, levels, enlargement, camerasDrawn, blending ("weighted", "hard");
/// arrays depthRanges, floats [view][nearest, farthest], metres, and depths, unsigned 16-bit
/// [view][level][row][column] (QuadDepths), left out where there is no view.
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::depth_quads
