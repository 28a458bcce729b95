// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"
#include "fitting/sparse/options.h"

#include <optional>

namespace sheen::fitting::detail {

/// How a texture and patches are fitted.
struct Options {
  sparse::Options patches{};
  /// Side of a texel on the surface, millimetres, > 0. Nothing: what a pixel covers in the first
  /// view.
  std::optional<float> texel_mm{};

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

OptionTable option_table(Options& options);

}  // namespace sheen::fitting::detail
