// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace sheen::core {

/// Directions in which points scatter about their mean.
struct PrincipalAxes {
  Eigen::Vector3d mean;
  Eigen::Matrix3d axes;    ///< columns, orthonormal, by falling spread; may mirror
  Eigen::Vector3d spread;  ///< singular values of the centred points
};

/// Of points as columns, at least three. In a file of its own, because Eigen's decomposition of
/// matrices of any width takes ten seconds to compile.
PrincipalAxes principal_axes(const Eigen::Matrix3Xd& points);

}  // namespace sheen::core
