// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::detail {

/// The texture, how many of its texels say something of their own (parameters "texelsStored" of
/// "texelsOffered"), and the offsets in the form of sparse patches (sparse/model_codec.h), those of
/// one term being zero. Where they are at anchors, these are the patches; "anchors", unsigned
/// 32-bit, names their vertices, the parameters "anchorSpacing" (metres) and "mirrored" say how
/// vertices blend and ask them (anchored_offsets.h).
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::detail
