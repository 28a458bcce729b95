// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::fitting {

/// A fitted surface light field: what is drawn, saved and exported. Every representation's model is
/// one; numbers are held in the precision of the model file, so that what is drawn, what is
/// measured and what is saved are the same.
class LightField {
 public:
  virtual ~LightField() = default;

  /// Name of the representation's descriptor and in the model file, e.g. "iwls".
  [[nodiscard]] virtual std::string_view representation() const = 0;

  /// Stored numbers; each colour channel counts, a stored index counts as one.
  [[nodiscard]] virtual std::size_t coefficient_count() const = 0;

  /// Parts that change and are sent to a renderer on their own (ModelUpdate). What a part is, only
  /// the representation and its renderer know; a PatchLightField's first ones are its patches.
  [[nodiscard]] virtual std::size_t element_count() const = 0;

  /// Colour of every vertex of `mesh`, sRGB in [0, 1]: what mesh viewers show that know nothing of
  /// light fields. `mesh` is the one that the light field was fitted to.
  [[nodiscard]] virtual std::vector<Eigen::Vector3f> vertex_colours(
      const core::Mesh& mesh) const = 0;
};

}  // namespace sheen::fitting
