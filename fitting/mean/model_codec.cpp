// SPDX-License-Identifier: MIT
#include "fitting/mean/model_codec.h"

#include "fitting/mean/mean_light_field.h"

#include <utility>

namespace sheen::fitting::mean {

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const MeanLightField&>(light_field);
  ModelPart part;
  part.observed = std::as_bytes(std::span(model.observed()));
  part.arrays["coefficients"] = std::as_bytes(model.coefficients());
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  auto observed = required_observed(part, mesh.positions.size());
  std::vector<Eigen::half> coefficients =
      required_halves(part, "coefficients", 3 * observed.size());
  return std::make_unique<MeanLightField>(std::move(coefficients), std::move(observed));
}

}  // namespace sheen::fitting::mean
