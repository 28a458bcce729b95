// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::core {

/// A connected part of a surface laid flat: its triangles keep their orientation and no two of them
/// cover the same texel.
struct Chart {
  std::vector<std::uint32_t> triangles;                 ///< of the mesh, ascending
  std::vector<std::array<Eigen::Vector2f, 3>> corners;  ///< of each of them, texels, >= 0
  Eigen::Vector2f size = Eigen::Vector2f::Zero();       ///< largest coordinates of the corners
};

/// Charts of a whole mesh: every triangle lies in exactly one. Each is a parallel projection,
/// enlarged so that it covers as many texels as the surface has texel_m squared (> 0); a triangle's
/// area in texels is thus within kLeastFlatteningCosine and its inverse of that of the surface. A
/// part that would fold over another becomes a chart of its own.
std::vector<Chart> make_charts(const Mesh& mesh, float texel_m);

}  // namespace sheen::core
