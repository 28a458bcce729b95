// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::spherical_harmonics {

/// Parameter: degree. Array: coefficients, half floats [patch][term][r, g, b], terms in the order
/// of basis.h.
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::spherical_harmonics
