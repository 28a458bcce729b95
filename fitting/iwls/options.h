// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

#include <optional>
#include <string_view>

namespace sheen::fitting::iwls {

enum class Construction { quadtree, adaptive, batch };
enum class Layout { grid, jittered_grid, disk, jittered_disk };

/// Names as options and model files spell them, e.g. "jittered-disk".
std::string_view name_of(Construction construction);
std::string_view name_of(Layout layout);
std::optional<Layout> layout_named(std::string_view name);

/// How an IWLS model is built (docs/algorithm.md).
struct Options {
  Construction construction = Construction::quadtree;
  Layout layout = Layout::grid;
  int centers = 16;  ///< 16 or 64
  int terms = 3;     ///< polynomial terms per centre: 1, 3 or 6; 0 = as many as the samples carry
  bool faithful = false;  ///< exactly the paper's rules: 3 terms (also where terms is 0), no ridge
  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

/// What users choose of it; the construction is called "fitter".
OptionTable option_table(Options& options);

}  // namespace sheen::fitting::iwls
