// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/triangle_shapes.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// A triangle is projected along a direction only if its normal has at least this cosine with it:
/// then projection shrinks its area by no more than this factor.
inline constexpr float kLeastFlatteningCosine = 0.25f;

/// Along which direction each triangle of a mesh is projected onto a plane.
struct Flattening {
  std::vector<Eigen::Vector3f> directions;  ///< unit vectors, object frame
  std::vector<std::uint8_t> of_triangle;    ///< index into `directions`
};

/// Directions that suit a mesh, and for every triangle one of them. They minimise
///
///     sum_t area_t (1 - cos(normal_t, direction_t)) + boundary_m length of all sides at which
///                                                                    the direction changes,
///
/// the area lost to slanted projection against what a boundary costs, so that regions of one
/// direction are large and their outlines short. A local minimum: spherical k-means from the six
/// axes, triangles by iterated conditional modes, then small regions as wholes. `neighbours` are
/// those of triangle_neighbours.
Flattening flatten(const Mesh& mesh, const TriangleShapes& shapes,
                   const std::vector<std::array<std::uint32_t, 3>>& neighbours, float boundary_m);

}  // namespace sheen::core
