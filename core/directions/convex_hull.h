// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sheen::core {

/// The convex hull's faces, triangles of indices into `points`, in any winding; nothing where the
/// points lie in a plane. Faces of more corners are cut into triangles.
std::optional<std::vector<std::array<std::uint32_t, 3>>> convex_hull(
    std::span<const Eigen::Vector3d> points);

}  // namespace sheen::core
