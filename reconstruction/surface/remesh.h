// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <functional>

namespace sheen::reconstruction {

/// Brings a point near a surface onto it; board frame, metres.
using ProjectOntoSurface = std::function<Eigen::Vector3f(const Eigen::Vector3f&)>;

/// Triangles of even size on the same surface: edges above 4/3 of `edge_m` are split, those below
/// 4/5 collapsed, valences evened by flips, vertices relaxed along the surface and projected onto
/// it (Botsch and Kobbelt 2004). `mesh` must be closed and manifold, and so is the result; what
/// would fold it is not done. Deterministic.
core::Mesh remesh(const core::Mesh& mesh, float edge_m, int rounds,
                  const ProjectOntoSurface& project);

}  // namespace sheen::reconstruction
