// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace sheen::fitting::billboard {

/// Numbers of directions that there are: 20 * 4^k, the triangles of an icosahedron whose triangles
/// were cut into four k times.
inline constexpr std::array<int, 5> kDirectionCounts{20, 80, 320, 1280, 5120};

/// Directions all over the sphere, unit vectors: the centroids of those triangles, the same in
/// every call. `count` is one of kDirectionCounts.
std::vector<Eigen::Vector3f> directions(int count);

}  // namespace sheen::fitting::billboard
