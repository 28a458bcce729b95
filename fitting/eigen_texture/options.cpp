// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/options.h"

#include "fitting/detail/options.h"

#include <string>

namespace sheen::fitting::eigen_texture {
namespace {

constexpr int kMostBases = 256;
constexpr int kLeastSide = 16;
constexpr int kMostSide = 4096;

}  // namespace

void Options::check() const {
  require_value(bases >= 0 && bases <= kMostBases, "bases", bases,
                "0 to " + std::to_string(kMostBases));
  require_value(texture_side >= kLeastSide && texture_side <= kMostSide, "texture-side",
                texture_side, std::to_string(kLeastSide) + " to " + std::to_string(kMostSide));
  require_value(!texel_mm || *texel_mm > 0.0f, detail::kTexelOption, texel_mm.value_or(0),
                "above 0");
}

OptionTable option_table(Options& options) {
  return {number_option("bases", options.bases, 0, kMostBases,
                        "Basis textures of the three colour channels together"),
          number_option("texture-side", options.texture_side, kLeastSide, kMostSide,
                        "The texture has at most so many texels squared"),
          choice_option("eigen-solve", options.solve,
                        {{"batch", Solve::batch}, {"incremental", Solve::incremental}},
                        "Bases are found at the end from all views, or while views arrive"),
          number_option(detail::kTexelOption, options.texel_mm, detail::kLeastTexel_mm,
                        detail::kMostTexel_mm,
                        "Side of a texel on the surface, mm (default: what a pixel covers "
                        "there)")};
}

}  // namespace sheen::fitting::eigen_texture
