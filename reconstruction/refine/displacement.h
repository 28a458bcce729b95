// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/refine/rims.h"

#include <Eigen/Geometry>

#include <vector>

namespace sheen::reconstruction {

/// What a step of the refinement weighs against each other.
struct DisplacementWeights {
  float rims = 1;
  float smoothness = 1;  ///< of the surface, against its filtered normals
  float stay = 0.01F;    ///< pull of every vertex towards where it is
};

/// Moves of all vertices along their normals, metres, that bring rims to where the images want them
/// and turn the triangles towards `triangle_normals`: linear least squares over
///   rims w (d(rim) - shift)^2 + smoothness (n . (p_j - p_i))^2 + stay d^2
/// by conjugate gradients.
std::vector<float> solve_displacement(const core::Mesh& mesh, const std::vector<RimPoint>& rims,
                                      const std::vector<Eigen::Vector3f>& triangle_normals,
                                      const DisplacementWeights& weights);

}  // namespace sheen::reconstruction
