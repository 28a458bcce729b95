// SPDX-License-Identifier: MIT
#include "fitting/detail/model_codec.h"

#include "fitting/detail/detail_light_field.h"
#include "fitting/sparse/model_codec.h"

#include <utility>

namespace sheen::fitting::detail {

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const DetailLightField&>(light_field);
  ModelPart part = sparse::encode_patches(model.offsets(), sparse::SingleColours::zero);
  part.texture = &model.texture();
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  if (part.texture == nullptr) throw ModelFault("it has no texture");
  return std::make_unique<DetailLightField>(
      mesh, *part.texture, sparse::decode_patches(part, mesh, sparse::SingleColours::zero));
}

}  // namespace sheen::fitting::detail
