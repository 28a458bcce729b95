// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/patch_light_field.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace sheen::exporters::viewer {

/// Offsets at anchors, that the page blends within triangles as render/detail/detail.glsl does.
struct AnchorTexels {
  std::size_t texels_per_anchor = 1;
  /// As those of patches; the number behind the colour is a whole one.
  std::vector<std::int16_t> values;
  double step = 1;
  bool mirrored = false;
  std::vector<std::int32_t> vertices;  ///< of every anchor
  /// Per vertex of the mesh so many: anchors that it blends, and the weights, of 65535.
  std::size_t blended_per_vertex = 0;
  std::vector<std::int32_t> blended, weights;
};

/// The patches of a light field as the native shaders read them (render/NAME/NAME.glsl), in whole
/// numbers.
struct PatchTexels {
  std::size_t texels_per_patch = 1;
  /// [patch][texel][r, g, b, a]: multiples of `step` and, in the fourth place, of `last_step`.
  std::vector<std::int16_t> values;
  double step = 1, last_step = 1;
  /// What the shader is told besides: "shader" names it.
  nlohmann::json shader;
  /// Null: there are none.
  std::unique_ptr<const AnchorTexels> anchors;
  /// The light field with its coefficients rounded in the same way.
  std::unique_ptr<const fitting::LightField> rounded;
};

/// Throws core::Error (bad_input) for representations that the viewer cannot draw.
PatchTexels patch_texels(const core::Mesh& mesh, const fitting::LightField& light_field);

}  // namespace sheen::exporters::viewer
