// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace sheen::fitting {

/// What one call did to a patch of a model.
struct FitOutcome {
  std::size_t fits = 0;  ///< systems solved
  bool changed = false;  ///< a stored number changed
};

}  // namespace sheen::fitting
