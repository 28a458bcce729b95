// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/kept_views/kept_view.h"
#include "fitting/option_table.h"

#include <string>

namespace sheen::fitting::billboard {

/// How frames become one image.
enum class Blending {
  blended,  ///< the directions around, each read where its depths say; weights by angle
  nearest,  ///< the paper's: the nearest direction on a plane through the object's centre
};

/// How frames are baked and drawn (docs/systems.md).
struct Options {
  int directions = 320;          ///< one of kDirectionCounts
  int side_px = 192;             ///< of a frame, [16, 1024]
  double field_of_view_deg = 0;  ///< frames are baked with, [0, 120]; 0: orthographic
  Blending blending = Blending::blended;
  std::string baked_from = "sparse";  ///< representation that is fitted first, one of patches
  KeptViewOptions views{};            ///< how frames are kept

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::billboard
