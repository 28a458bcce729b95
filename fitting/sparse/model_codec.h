// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"
#include "fitting/sparse/light_field_model.h"

#include <cstdint>
#include <memory>
#include <span>

namespace sheen::fitting::sparse {

/// Patches of one term: their colour is stored, or they are known to be zero and take nothing.
enum class SingleColours { stored, zero };

/// Parameter: atoms, the dictionary as [x, y, support] each, which is always the same. Arrays, all
/// patch after patch: "shapes", one byte per patch: number of RBFs, plus 128 for the linear base;
/// "bumps", an unsigned 16-bit number per RBF: its atom (left out when there are none);
/// "coefficients", half floats [term][r, g, b], base first (left out when there are none).
ModelPart encode_patches(const LightFieldModel& model, SingleColours single_colours);
/// A patch for each of the flags, which say whether it was observed.
LightFieldModel decode_patches(const ModelPart& part, std::span<const std::uint8_t> observed,
                               SingleColours single_colours);

/// The same as a model's only part; all colours are stored.
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::sparse
