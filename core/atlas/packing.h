// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <vector>

namespace sheen::core {

/// Rectangles side by side in a larger one.
struct Packing {
  Eigen::Vector2i size{0, 0};
  std::vector<Eigen::Vector2i> origins;  ///< lowest corner of every rectangle
};

/// Packs rectangles (all sides >= 1) without overlap into about a square, in any order but always
/// the same: bottom-left under a skyline, the highest first.
Packing pack_rectangles(const std::vector<Eigen::Vector2i>& sizes);

}  // namespace sheen::core
