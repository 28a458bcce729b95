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

/// The same in the coordinates of the mesh's file.
inline Eigen::AlignedBox3d file_bounds_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box = bounds_of(mesh).cast<double>();
  if (!box.isEmpty()) box.translate(mesh.offset);
  return box;
}

/// Lets a mesh be given with another offset: positions move by the difference, in double precision.
inline void move_offset(Mesh& mesh, const Eigen::Vector3d& offset) {
  const Eigen::Vector3d shift = mesh.offset - offset;
  if (!shift.isZero(0)) {
    for (Eigen::Vector3f& position : mesh.positions) {
      position = (position.cast<double>() + shift).cast<float>();
    }
  }
  mesh.offset = offset;
}

}  // namespace sheen::core
