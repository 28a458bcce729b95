// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_codec.h"

namespace sheen::fitting::spherical_harmonics {

/// Parameter: degree. Array: coefficients, half floats [patch][term][r, g, b], terms in the order
/// of basis.h.
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part,
                                               std::vector<std::uint8_t> observed);

}  // namespace sheen::fitting::spherical_harmonics
