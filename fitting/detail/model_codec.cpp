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
  part.parameters["texelsStored"] = model.texture().texel_count().stored;
  part.parameters["texelsOffered"] = model.texture().texel_count().offered;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  if (part.texture == nullptr) throw ModelFault("it has no texture");
  const TexelCount count{required_size(part.parameters, "texelsStored"),
                         required_size(part.parameters, "texelsOffered")};
  if (count.stored > count.offered || count.offered > part.texture->texels().size()) {
    throw ModelFault("it counts more texels than it has");
  }
  auto model = std::make_unique<DetailLightField>(
      mesh, *part.texture, sparse::decode_patches(part, mesh, sparse::SingleColours::zero));
  model->texture().set_texel_count(count);
  return model;
}

}  // namespace sheen::fitting::detail
