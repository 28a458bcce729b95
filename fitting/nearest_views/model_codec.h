// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_codec.h"

namespace sheen::fitting::nearest_views {

/// No parameters. Arrays: "counts", the number of samples of every patch, 32-bit; "samples", half
/// floats [patch][sample][u, v, r, g, b] (left out when there are none).
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part,
                                               std::vector<std::uint8_t> observed);

}  // namespace sheen::fitting::nearest_views
