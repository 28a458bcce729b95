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
constexpr const char* kLevels = "anchorLevels";
constexpr const char* kCount = "count";
constexpr const char* kSpacing = "spacing";
constexpr const char* kMirrored = "mirrored";
/// Of the only level, in files without "anchorLevels".
constexpr const char* kOnlySpacing = "anchorSpacing";
constexpr std::size_t kMostLevels = 4;

/// What a part points to besides the model.
struct Owned {
  std::shared_ptr<const void> patches;
  std::vector<std::uint32_t> anchors;
};

ModelPart encode_offsets(const DetailLightField& model) {
  if (!model.anchors()) return sparse::encode_patches(model.offsets(), SingleColours::zero);
  const AnchoredOffsets& anchors = *model.anchors();
  ModelPart part = sparse::encode_patches(anchors.models(), SingleColours::zero);
  const auto owned = std::make_shared<Owned>();
  owned->patches = std::move(part.owner);
  nlohmann::json levels = nlohmann::json::array();
  for (const AnchorLevel& level : anchors.levels()) {
    owned->anchors.insert(owned->anchors.end(), level.vertices.begin(), level.vertices.end());
    levels.push_back(
        {{kCount, level.vertices.size()}, {kSpacing, static_cast<double>(level.spacing_m)}});
  }
  part.observed = std::as_bytes(std::span(model.observed()));
  part.arrays[kAnchors] = std::as_bytes(std::span(owned->anchors));
  part.parameters[kLevels] = std::move(levels);
  part.parameters[kMirrored] = anchors.asked() == AskedDirection::mirrored;
  part.owner = owned;
  return part;
}

/// How many anchors each level has, and how far apart they are.
struct LevelSize {
  std::size_t count;
  float spacing_m;
};

std::vector<LevelSize> decode_level_sizes(const ModelPart& part, std::size_t anchor_count) {
  if (part.parameters.contains(kOnlySpacing)) {
    return {{anchor_count, static_cast<float>(required_number(part.parameters, kOnlySpacing))}};
  }
  const nlohmann::json& levels = required(part.parameters, kLevels);
  if (!levels.is_array() || levels.empty() || levels.size() > kMostLevels) {
    throw ModelFault("its \"anchorLevels\" are not a list of one to four");
  }
  std::vector<LevelSize> sizes;
  for (const nlohmann::json& level : levels) {
    sizes.push_back(
        {required_size(level, kCount), static_cast<float>(required_number(level, kSpacing))});
  }
  return sizes;
}

std::vector<AnchorLevel> decode_levels(const ModelPart& part, const core::Mesh& mesh) {
  std::vector<std::uint32_t> anchors(part.arrays.at(kAnchors).size() / sizeof(std::uint32_t));
  const auto array = required_bytes(part, kAnchors, anchors.size() * sizeof(std::uint32_t));
  if (!array.empty()) std::memcpy(anchors.data(), array.data(), array.size());
  if (anchors.empty()) throw ModelFault("it has a list of no anchors");
  std::vector<AnchorLevel> levels;
  std::size_t taken = 0;
  for (const LevelSize& size : decode_level_sizes(part, anchors.size())) {
    if (!(size.spacing_m > 0.0f && std::isfinite(size.spacing_m))) {
      throw ModelFault("the spacing of its anchors is not positive");
    }
    if (size.count > anchors.size() - taken) throw ModelFault("it counts more anchors than it has");
    const auto first = anchors.begin() + static_cast<std::ptrdiff_t>(taken);
    levels.push_back({{first, first + static_cast<std::ptrdiff_t>(size.count)}, size.spacing_m});
    taken += size.count;
    if (!are_scattered(mesh, levels.back().vertices, size.spacing_m)) {
      throw ModelFault("its anchors are not vertices as far apart as it says");
    }
  }
  if (taken != anchors.size()) throw ModelFault("it has more anchors than it counts");
  return levels;
}

std::shared_ptr<const AnchoredOffsets> decode_anchors(const ModelPart& part,
                                                      const core::Mesh& mesh) {
  std::vector<AnchorLevel> levels = decode_levels(part, mesh);
  const nlohmann::json& mirrored = required(part.parameters, kMirrored);
  if (!mirrored.is_boolean()) throw ModelFault("its \"mirrored\" is neither true nor false");
  std::size_t count = 0;
  for (const AnchorLevel& level : levels) count += level.vertices.size();
  const std::vector<std::uint8_t> all(count, 1);
  return std::make_shared<const AnchoredOffsets>(
      mesh, std::move(levels),
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
