// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/kept_views/kept_view.h"
#include "fitting/option_table.h"

namespace sheen::fitting::depth_quads {

/// How quads of several cameras become one image.
enum class Blending {
  weighted,  ///< those near the surface, weighted by direction; cameras by angle at the object
  hard,      ///< the paper's: the nearest quad wins; cameras by distance from the viewing axis
};

/// Where the depths of quads come from.
enum class Depths {
  session,  ///< as a sensor measured them, where the session has depth images; else the mesh
  mesh,
};

/// How quads are made and drawn (docs/systems.md).
struct Options {
  int spacing_px = 3;        ///< of the finest level's quads, odd, [1, 63]
  int levels = 4;            ///< each 2 s + 1 pixels wide, [1, 6]
  double enlargement = 0.2;  ///< of a quad on every side, pixels of its photograph, [0, 1]
  int median = 3;            ///< side of the median filter on depths, odd, [1, 9]; 1: none
  Depths depths = Depths::session;
  int cameras = 3;  ///< drawn at once, [1, 64]
  Blending blending = Blending::weighted;
  KeptViewOptions views{};

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::depth_quads
