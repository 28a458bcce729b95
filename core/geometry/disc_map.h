// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace sheen::core {

/// Hemisphere <-> unit disc <-> square maps of docs/algorithm.md. A direction on the hemisphere is
/// a unit vector with z >= 0 in the tangent frame.

/// Orthographic: drop z. Inverse: z = sqrt(1 - u^2 - v^2), directions outside the disc are put on
/// the rim.
Eigen::Vector2f disc_from_hemisphere(const Eigen::Vector3f& direction);
Eigen::Vector3f hemisphere_from_disc(const Eigen::Vector2f& uv);

/// Shirley and Chiu's concentric map: square [-1,1]^2 -> unit disc, equal areas stay equal,
/// the square's concentric rings become circles.
Eigen::Vector2f disc_from_square(const Eigen::Vector2f& ab);
Eigen::Vector2f square_from_disc(const Eigen::Vector2f& uv);

}  // namespace sheen::core
