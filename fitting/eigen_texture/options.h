// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

#include <optional>

namespace sheen::fitting::eigen_texture {

/// When the bases are found.
enum class Solve {
  batch,       ///< at the end, from all views
  incremental  ///< while views arrive, each looked at once
};

struct Options {
  int bases = 36;          ///< of the three channels together, [0, 256]
  int texture_side = 512;  ///< the atlas has at most this side squared texels, [16, 4096]
  Solve solve = Solve::batch;
  /// Side of a texel on the surface, millimetres, > 0, larger where the atlas would have too many.
  /// Nothing: as small as fits.
  std::optional<float> texel_mm{};

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::eigen_texture
