// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace sheen::reconstruction {

/// How face normals are smoothed.
struct NormalFilter {
  int rounds = 5;
  float turn = 0.4F;  ///< difference of unit normals at which a neighbour's weight has fallen to
                      ///< exp(-1/2): smaller keeps more edges, larger takes more noise away
};

/// Normals of the triangles after bilateral filtering: averages over the triangles that share a
/// vertex, weighted by area and by how alike their normals are, so that flat faces become flat and
/// edges stay sharp (Zheng et al. 2011). Unit length.
std::vector<Eigen::Vector3f> filtered_normals(const core::Mesh& mesh, const NormalFilter& filter,
                                              int threads);

}  // namespace sheen::reconstruction
