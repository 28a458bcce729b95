// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/samples/vertex_view.h"

#include <Eigen/Geometry>

namespace sheen::core {

/// Decides which projected vertices are hidden by the mesh itself. Implementations hold the mesh
/// and must agree up to vertices whose neighbourhood is partly hidden (tests/render).
class Visibility {
 public:
  virtual ~Visibility() = default;

  /// Sets `view.rejection` to `occluded` where a vertex that was `none` is hidden from the camera.
  virtual void reject_occluded(const CameraModel& camera,
                               const Eigen::Isometry3d& camera_from_object, VertexView& view) = 0;
};

}  // namespace sheen::core
