// SPDX-License-Identifier: MIT
#include "fitting/detail/options.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting::detail {

void Options::check() const {
  patches.check();
  if (texel_mm && !(*texel_mm > 0.0f)) {
    throw std::invalid_argument("texel-mm is " + std::to_string(*texel_mm) +
                                ", it must be positive");
  }
  if (!(anchor_px > 0)) {
    throw std::invalid_argument("anchor-px is " + std::to_string(anchor_px) +
                                ", it must be positive");
  }
}

OptionTable option_table(Options& options) {
  OptionTable table = sparse::option_table(options.patches);
  table.push_back(number_option(kTexelOption, options.texel_mm, kLeastTexel_mm, kMostTexel_mm,
                                "Side of a texel on the surface, mm (default: what a pixel covers "
                                "there)"));
  table.push_back(choice_option<OffsetPlaces>(
      "offsets", options.offsets,
      {{"auto", OffsetPlaces::automatic},
       {"vertex", OffsetPlaces::vertex},
       {"anchors", OffsetPlaces::anchors}},
      "Where the model keeps how colours change with the direction: at every vertex; at anchors "
      "between which the surface blends: fewer bytes, better on smooth glossy shapes, slower; "
      "auto: where directions left out of the fit are predicted better"));
  table.push_back(number_option("anchor-px", options.anchor_px, kLeastAnchor_px, kMostAnchor_px,
                                "The distance of the finer anchors, texels"));
  return table;
}

}  // namespace sheen::fitting::detail
