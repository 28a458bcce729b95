// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "core/visibility/ray_caster.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

namespace sheen::pipeline {

/// Where an object is in images: pixels whose ray, through the lens, meets the mesh from either
/// side.
class ObjectMask {
 public:
  /// Borrows the mesh.
  ObjectMask(const core::Mesh& mesh, int threads);

  /// CV_8UC1 of the camera's size: 255 on the object.
  [[nodiscard]] cv::Mat draw(const core::CameraModel& camera,
                             const Eigen::Isometry3d& camera_from_object) const;

 private:
  const core::Mesh& mesh_;
  core::RayCaster rays_;
  int threads_;
};

}  // namespace sheen::pipeline
