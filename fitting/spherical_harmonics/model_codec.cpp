// SPDX-License-Identifier: MIT
#include "fitting/spherical_harmonics/model_codec.h"

#include "fitting/spherical_harmonics/light_field_model.h"

#include <utility>

namespace sheen::fitting::spherical_harmonics {

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const LightFieldModel&>(light_field);
  ModelPart part;
  part.observed = std::as_bytes(std::span(model.observed()));
  part.parameters = {{"degree", static_cast<unsigned>(model.degree())}};
  part.arrays["coefficients"] = std::as_bytes(model.coefficients());
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  auto observed = required_observed(part, mesh.positions.size());
  const std::size_t degree = required_size(part.parameters, "degree");
  if (degree < 1 || degree > std::size_t{kMaxDegree}) {
    throw ModelFault("its \"degree\" is not 1, 2 or 3");
  }
  const auto valid_degree = static_cast<int>(degree);
  std::vector<Eigen::half> coefficients =
      required_halves(part, "coefficients", observed.size() * 3 * term_count(valid_degree));
  return std::make_unique<LightFieldModel>(valid_degree, std::move(coefficients),
                                           std::move(observed));
}

}  // namespace sheen::fitting::spherical_harmonics
