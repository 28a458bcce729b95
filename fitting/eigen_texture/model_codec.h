// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::eigen_texture {

/// The mean texture as the file's texture, the mean colours of the vertices as representation
/// `mean` keeps them; parameters usedTexels, views and bases (of the three channels); arrays
/// directions, and bases and coefficients of every channel that has some.
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::eigen_texture
