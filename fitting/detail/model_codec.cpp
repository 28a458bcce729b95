// SPDX-License-Identifier: MIT
#include "fitting/detail/model_codec.h"

#include "fitting/detail/detail_light_field.h"
#include "fitting/sparse/model_codec.h"

#include <cmath>
#include <cstring>
#include <utility>

namespace sheen::fitting::detail {
namespace {

using sparse::SingleColours;

constexpr const char* kAnchors = "anchors";
constexpr const char* kSpacing = "anchorSpacing";
constexpr const char* kMirrored = "mirrored";

ModelPart encode_offsets(const DetailLightField& model) {
  if (!model.anchors()) return sparse::encode_patches(model.offsets(), SingleColours::zero);
  const AnchoredOffsets& anchors = *model.anchors();
  ModelPart part = sparse::encode_patches(anchors.models(), SingleColours::zero);
  part.observed = std::as_bytes(std::span(model.observed()));
  part.arrays[kAnchors] = std::as_bytes(std::span(anchors.layout().vertices));
  part.parameters[kSpacing] = static_cast<double>(anchors.layout().spacing_m);
  part.parameters[kMirrored] = anchors.asked() == AskedDirection::mirrored;
  return part;
}

AnchorLayout decode_layout(const ModelPart& part, const core::Mesh& mesh) {
  const std::size_t bytes = part.arrays.at(kAnchors).size();
  AnchorLayout layout{std::vector<std::uint32_t>(bytes / sizeof(std::uint32_t)),
                      static_cast<float>(required_number(part.parameters, kSpacing))};
  if (!(layout.spacing_m > 0.0f && std::isfinite(layout.spacing_m))) {
    throw ModelFault("its \"anchorSpacing\" is not positive");
  }
  const auto array = required_bytes(part, kAnchors, layout.vertices.size() * sizeof(std::uint32_t));
  if (!array.empty()) std::memcpy(layout.vertices.data(), array.data(), array.size());
  if (!are_scattered(mesh, layout.vertices, layout.spacing_m)) {
    throw ModelFault("its anchors are not vertices as far apart as it says");
  }
  return layout;
}

std::shared_ptr<const AnchoredOffsets> decode_anchors(const ModelPart& part,
                                                      const core::Mesh& mesh) {
  AnchorLayout layout = decode_layout(part, mesh);
  const nlohmann::json& mirrored = required(part.parameters, kMirrored);
  if (!mirrored.is_boolean()) throw ModelFault("its \"mirrored\" is neither true nor false");
  const std::vector<std::uint8_t> all(layout.vertices.size(), 1);
  return std::make_shared<const AnchoredOffsets>(
      mesh, std::move(layout),
      mirrored.get<bool>() ? AskedDirection::mirrored : AskedDirection::same,
      sparse::decode_patches(part, all, SingleColours::zero));
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const DetailLightField&>(light_field);
  ModelPart part = encode_offsets(model);
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
  const auto observed = required_observed(part, mesh.positions.size());
  const bool at_anchors = part.arrays.contains(kAnchors);
  auto model = std::make_unique<DetailLightField>(
      mesh, *part.texture,
      at_anchors ? no_offsets(observed)
                 : sparse::decode_patches(part, observed, SingleColours::zero));
  if (at_anchors) model->set_anchors(decode_anchors(part, mesh));
  model->texture().set_texel_count(count);
  return model;
}

}  // namespace sheen::fitting::detail
