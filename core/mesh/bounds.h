// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

namespace sheen::core {

/// Bounding box of all vertices, object frame, metres; empty for a mesh without any.
inline Eigen::AlignedBox3f bounds_of(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
  return box;
}

}  // namespace sheen::core
