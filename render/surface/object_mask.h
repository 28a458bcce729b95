// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "render/context/context.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <memory>

namespace sheen::render {

/// Which pixels see a mesh: what every representation is measured on, whatever it draws itself.
class ObjectMask {
 public:
  /// Context and mesh outlive it.
  ObjectMask(Context& context, const core::Mesh& mesh);
  ~ObjectMask();
  ObjectMask(const ObjectMask&) = delete;
  ObjectMask& operator=(const ObjectMask&) = delete;
  ObjectMask(ObjectMask&&) = delete;
  ObjectMask& operator=(ObjectMask&&) = delete;

  /// CV_8UC1 of the camera's size: 255 where the mesh is seen, its lens included.
  cv::Mat seen_by(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::render
