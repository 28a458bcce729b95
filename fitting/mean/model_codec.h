// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_codec.h"

namespace sheen::fitting::mean {

/// No parameters. Array: coefficients, half floats [patch][r, g, b].
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part,
                                               std::vector<std::uint8_t> observed);

}  // namespace sheen::fitting::mean
