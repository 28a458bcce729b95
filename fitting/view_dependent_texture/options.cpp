// SPDX-License-Identifier: MIT
#include "fitting/view_dependent_texture/options.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting::view_dependent_texture {
namespace {

constexpr int kMostBlended = 16;

}  // namespace

void Options::check() const {
  if (blended_views < 1 || blended_views > kMostBlended) {
    throw std::invalid_argument("blended-views is " + std::to_string(blended_views) +
                                ", allowed: 1 to " + std::to_string(kMostBlended));
  }
  fitting::check(views);
}

OptionTable option_table(Options& options) {
  OptionTable table{number_option("blended-views", options.blended_views, 1, kMostBlended,
                                  "Photographs that give a pixel its colour")};
  add_options(options.views, table);
  return table;
}

}  // namespace sheen::fitting::view_dependent_texture
