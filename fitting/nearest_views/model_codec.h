// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::nearest_views {

/// No parameters. Arrays: "counts", the number of samples of every patch, 32-bit; "samples", half
/// floats [patch][sample][u, v, r, g, b] (left out when there are none).
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::nearest_views
