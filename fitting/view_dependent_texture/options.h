// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/kept_views/kept_view.h"
#include "fitting/option_table.h"

namespace sheen::fitting::view_dependent_texture {

struct Options {
  int blended_views = 4;  ///< photographs that give a pixel its colour, [1, 16]
  KeptViewOptions views{};

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::view_dependent_texture
