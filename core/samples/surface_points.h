// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <cstddef>
#include <vector>

namespace sheen::core {

/// The vertices of a mesh as the projection reads them, object frame, metres. Structure of arrays,
/// one entry per vertex. A vertex that no triangle uses is not part of the surface: its normal is
/// zero, so every view direction has cosine 0 there and it never gives a sample.
struct SurfacePoints {
  std::vector<float> x, y, z;     ///< position
  std::vector<float> nx, ny, nz;  ///< unit normal

  [[nodiscard]] std::size_t size() const { return x.size(); }
};

SurfacePoints surface_points(const Mesh& mesh);

}  // namespace sheen::core
