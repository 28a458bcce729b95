// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::sparse {

/// Parameter: atoms, the dictionary as [x, y, support] each, which is always the same. Arrays, all
/// patch after patch: "shapes", one byte per patch: number of RBFs, plus 128 for the linear base;
/// "bumps", an unsigned 16-bit number per RBF: its atom (left out when there are none);
/// "coefficients", half floats [term][r, g, b], base first.
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::sparse
