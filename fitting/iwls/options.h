// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sheen::fitting::iwls {

enum class Construction { quadtree, adaptive, batch };
enum class Layout { grid, jittered_grid, disk, jittered_disk };

/// How an IWLS model is built (docs/algorithm.md).
struct Options {
  Construction construction = Construction::quadtree;
  Layout layout = Layout::grid;
  int centers = 16;       ///< 16 or 64
  int terms = 3;          ///< polynomial terms per centre: 1, 3 or 6; 0 = as many as the samples carry
  bool faithful = false;  ///< exactly the paper's rules: 3 terms, no ridge
  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

}  // namespace sheen::fitting::iwls
