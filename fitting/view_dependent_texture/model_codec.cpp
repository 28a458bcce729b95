// SPDX-License-Identifier: MIT
#include "fitting/view_dependent_texture/model_codec.h"

#include "fitting/kept_views/view_codec.h"
#include "fitting/mean/model_codec.h"
#include "fitting/view_dependent_texture/view_texture.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sheen::fitting::view_dependent_texture {

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const ViewTexture&>(light_field);
  ModelPart part = mean::encode_model(model.means());
  encode_views(model.photographs(), model.options().views.cache_mb, part);
  part.parameters["blendedViews"] = static_cast<unsigned>(model.options().blended_views);
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  const auto means = mean::decode_model(part, mesh);
  DecodedViews decoded = decode_views(part);
  constexpr std::size_t far_too_many = 1000;
  Options options;
  options.blended_views =
      static_cast<int>(std::min(required_size(part.parameters, "blendedViews"), far_too_many));
  options.views.cache_mb = decoded.cache_mb;
  try {
    options.check();
  } catch (const std::invalid_argument& fault) {
    throw ModelFault(std::string("its ") + fault.what());
  }
  auto model = std::make_unique<ViewTexture>(options, mesh.positions.size());
  model->set_means(dynamic_cast<const mean::MeanLightField&>(*means));
  for (KeptView& view : decoded.views) model->add(std::move(view));
  return model;
}

}  // namespace sheen::fitting::view_dependent_texture
