// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

namespace sheen::fitting::multi_eigenspace {

/// What is drawn between a view of one eigenspace and a view of another.
enum class Switching {
  cross_fade,  ///< both, by the shares of their views
  hard,        ///< the paper's: the one with the larger share
};

/// Of a space, at most.
inline constexpr int kMostEigenimages = 16;

/// How views become eigenspaces and these a picture (docs/systems.md).
struct Options {
  int eigenimages = 3;          ///< of a space at most, [0, 16]; the paper's hardware has three
  double tolerance = 10;        ///< of a space, grey levels RMS over the object, [0, 255]
  int picture_px = 256;         ///< side of pictures, [16, 1024]
  double view_spacing_deg = 1;  ///< a view nearer to a kept one is left out, [0, 90]
  Switching switching = Switching::cross_fade;

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::multi_eigenspace
