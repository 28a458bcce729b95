// SPDX-License-Identifier: MIT
#include "fitting/iwls/model_codec.h"

#include "fitting/iwls/light_field_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sheen::fitting::iwls {
namespace {

using nlohmann::json;

// Far more than any layout has; keeps products of sizes far from overflow.
constexpr std::size_t kMaxCenters = 4096;
// Centres lie on the disc or in the corners of its square.
constexpr double kLargestCoordinate = 2.0;

Eigen::Vector2f center_from(const json& entry) {
  Eigen::Vector2f center;
  if (!entry.is_array() || entry.size() != 2) throw ModelFault("a centre is not a pair");
  for (std::size_t i = 0; i < 2; ++i) {
    if (!entry[i].is_number() || !(std::abs(entry[i].get<double>()) <= kLargestCoordinate)) {
      throw ModelFault("a centre lies far from the disc");
    }
    center[static_cast<Eigen::Index>(i)] = entry[i].get<float>();
  }
  return center;
}

std::vector<Eigen::Vector2f> centers_from(const json& list) {
  if (!list.is_array() || list.empty() || list.size() > kMaxCenters) {
    throw ModelFault("its \"centers\" is not a list of centres");
  }
  std::vector<Eigen::Vector2f> centers;
  for (const json& entry : list) centers.push_back(center_from(entry));
  return centers;
}

// Whether the supports cover the closed disc, so that eq. 7 never divides by zero. Every direction
// lies within half a diagonal of a point of the lattice: supports that reach so far beyond each of
// these points leave no hole.
bool covers_disc(const ModelShape& shape) {
  constexpr int steps = 20;
  constexpr float step = 1.0f / static_cast<float>(steps);
  constexpr float half_diagonal = 0.7072f * step;
  const float reach = shape.support_radius - half_diagonal;
  if (reach <= 0.0f) return false;
  for (int y = -steps; y <= steps; ++y) {
    for (int x = -steps; x <= steps; ++x) {
      const Eigen::Vector2f point = step * Eigen::Vector2i(x, y).cast<float>();
      if (point.norm() > 1.0f + half_diagonal) continue;
      const auto covers = [&](const Eigen::Vector2f& center) {
        return (point - center).squaredNorm() < reach * reach;
      };
      if (std::ranges::none_of(shape.centers, covers)) return false;
    }
  }
  return true;
}

ModelShape shape_from(const json& parameters) {
  ModelShape shape;
  const auto layout = layout_named(required_string(parameters, "layout"));
  if (!layout) throw ModelFault("its layout is unknown");
  shape.layout = *layout;
  shape.centers = centers_from(required(parameters, "centers"));
  const std::size_t terms = required_size(parameters, "terms");
  if (terms != 1 && terms != 3 && terms != 6) throw ModelFault("its \"terms\" is not 1, 3 or 6");
  shape.terms = static_cast<int>(terms);
  shape.support_radius = static_cast<float>(required_number(parameters, "supportRadius"));
  if (!(shape.support_radius > 1e-3f && shape.support_radius < 1e3f)) {
    throw ModelFault("its \"supportRadius\" is out of range");
  }
  if (!covers_disc(shape)) throw ModelFault("its centres leave directions without any support");
  return shape;
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const LightFieldModel&>(light_field);
  const ModelShape& shape = model.shape();
  json centers = json::array();
  for (const Eigen::Vector2f& center : shape.centers) {
    centers.push_back({static_cast<double>(center.x()), static_cast<double>(center.y())});
  }
  ModelPart part;
  part.observed = std::as_bytes(std::span(model.observed()));
  part.parameters = {{"layout", name_of(shape.layout)},
                     {"centers", std::move(centers)},
                     {"terms", static_cast<unsigned>(shape.terms)},
                     {"supportRadius", static_cast<double>(shape.support_radius)}};
  const auto coefficients =
      std::make_shared<const std::vector<Eigen::half>>(model.coefficients_by_center());
  part.arrays["coefficients"] = std::as_bytes(std::span(*coefficients));
  part.owner = coefficients;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  auto observed = required_observed(part, mesh.positions.size());
  ModelShape shape = shape_from(part.parameters);
  const std::size_t count =
      observed.size() * shape.centers.size() * static_cast<std::size_t>(3 * shape.terms);
  return std::make_unique<LightFieldModel>(
      std::move(shape), required_halves(part, "coefficients", count), std::move(observed));
}

}  // namespace sheen::fitting::iwls
