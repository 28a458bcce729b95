// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace sheen::fitting::detail {

/// Side of a cell of directions, in the cube around their sphere: 17 degrees, so that a check
/// direction lies up to about 9 from those that are fitted, as novel views do.
inline constexpr float kCheckCell = 0.3f;

/// Whether predictions are checked towards `w` (unit, object frame) instead of being fitted there:
/// in every seventh of the cells, no two of which share a face. Cells and not views, because the
/// views beside one of a walk show nearly the same.
inline bool is_check_direction(const Eigen::Vector3f& w) {
  const auto cell = [](float x) { return static_cast<int>(std::floor((x + 1.0f) / kCheckCell)); };
  return (cell(w.x()) + 2 * cell(w.y()) + 3 * cell(w.z())) % 7 == 0;
}

/// Which samples are fitted.
enum class FittedDirections { all, without_checks };

}  // namespace sheen::fitting::detail
