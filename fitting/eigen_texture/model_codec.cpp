// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/model_codec.h"

#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/mean/model_codec.h"

#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

using nlohmann::json;

constexpr std::size_t kMostViews = std::size_t{1} << 20;
constexpr std::size_t kMostStoredBases = 256;
constexpr std::array<const char*, 3> kBases{"lumaBases", "blueBases", "redBases"};
constexpr std::array<const char*, 3> kCoefficients{"lumaCoefficients", "blueCoefficients",
                                                   "redCoefficients"};

std::vector<Eigen::Vector3f> directions_from(const ModelPart& part, std::size_t views) {
  std::vector<Eigen::Vector3f> directions(views);
  if (views == 0) return directions;
  const auto bytes = required_bytes(part, "directions", views * sizeof(Eigen::Vector3f));
  std::memcpy(static_cast<void*>(directions.data()), bytes.data(), bytes.size());
  for (const Eigen::Vector3f& one : directions) {
    constexpr float rounding = 1e-4f;
    if (!(std::abs(one.norm() - 1.0f) < rounding)) throw ModelFault("a direction is none");
  }
  return directions;
}

Channel channel_from(const ModelPart& part, std::size_t channel_idx, std::size_t bases,
                     std::size_t texels, std::size_t views) {
  Channel channel{bases, {}, {}};
  if (bases == 0) return channel;
  if (views == 0 || texels == 0) throw ModelFault("it has bases of nothing");
  const auto bytes = required_bytes(part, kBases[channel_idx], bases * texels);
  channel.texels.resize(bytes.size());
  std::memcpy(channel.texels.data(), bytes.data(), bytes.size());
  channel.coefficients = required_halves(part, kCoefficients[channel_idx], bases * views);
  for (const Eigen::half one : channel.coefficients) {
    if (!(std::abs(static_cast<float>(one)) < std::ceil(kMostCoefficient))) {
      throw ModelFault("a coefficient is larger than sheen makes them");
    }
  }
  return channel;
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const EigenTexture&>(light_field);
  ModelPart part = mean::encode_model(model.vertex_means());
  part.texture = &model.mean();
  part.parameters["usedTexels"] = model.used().size();
  part.parameters["views"] = model.directions().size();
  json& bases = part.parameters["bases"] = json::array();
  if (!model.directions().empty()) {
    part.arrays["directions"] = std::as_bytes(std::span(model.directions()));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const Channel& channel = model.channels()[c];
    bases.push_back(channel.bases);
    // glTF knows no empty bufferView.
    if (channel.bases == 0) continue;
    part.arrays[kBases[c]] = std::as_bytes(std::span(channel.texels));
    part.arrays[kCoefficients[c]] = std::as_bytes(std::span(channel.coefficients));
  }
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  if (part.texture == nullptr) throw ModelFault("it has no texture");
  const auto means = mean::decode_model(part, mesh);
  auto model = std::make_unique<EigenTexture>(mesh, *part.texture);
  model->set_vertex_means(dynamic_cast<const mean::MeanLightField&>(*means));
  const std::size_t views = required_size(part.parameters, "views");
  const json& bases = required(part.parameters, "bases");
  if (required_size(part.parameters, "usedTexels") != model->used().size()) {
    throw ModelFault("its bases are of another texture");
  }
  if (views > kMostViews || !bases.is_array() || bases.size() != 3) {
    throw ModelFault("it has no bases of three channels");
  }
  std::array<Channel, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!bases[c].is_number_unsigned() || bases[c].get<std::size_t>() > kMostStoredBases) {
      throw ModelFault("it has too many bases");
    }
    channels[c] = channel_from(part, c, bases[c].get<std::size_t>(), model->used().size(), views);
  }
  model->set_bases(std::move(channels), directions_from(part, views));
  return model;
}

}  // namespace sheen::fitting::eigen_texture
