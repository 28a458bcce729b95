// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace sheen::reconstruction {

/// The directions in which somebody who walks round an object stands: three heights above the
/// sheet, 16 places at each, counted ring by ring from the lowest.
inline constexpr std::size_t kViewPlaces = 16;
inline constexpr std::size_t kViewDirections = 3 * kViewPlaces;

/// Which of them points from the object to an eye (board frame); nothing for eyes lower than 8 or
/// higher than 80 degrees above the sheet.
std::optional<std::size_t> view_direction_of(const Eigen::Vector3d& towards_eye);

/// The middle of one of them, unit length.
Eigen::Vector3d middle_of_direction(std::size_t direction);

}  // namespace sheen::reconstruction
