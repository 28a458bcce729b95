// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/options.h"

#include "fitting/detail/options.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting::eigen_texture {
namespace {

constexpr int kMostBases = 256;
constexpr int kLeastSide = 16;
constexpr int kMostSide = 4096;

void demand(bool holds, const char* name, double value, const std::string& allowed) {
  if (holds) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                              ", allowed: " + allowed);
}

}  // namespace

void Options::check() const {
  demand(bases >= 0 && bases <= kMostBases, "bases", bases, "0 to " + std::to_string(kMostBases));
  demand(texture_side >= kLeastSide && texture_side <= kMostSide, "texture-side", texture_side,
         std::to_string(kLeastSide) + " to " + std::to_string(kMostSide));
  demand(!texel_mm || *texel_mm > 0.0f, detail::kTexelOption, texel_mm.value_or(0), "above 0");
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
