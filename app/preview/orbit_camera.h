// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

namespace sheen::app {

/// Turntable camera round an object: azimuth and elevation about an upright axis, as other 3D
/// viewers have it. Object frame, metres.
class OrbitCamera {
 public:
  /// Frames the mesh and as much round it as a sphere `room` times its size takes; `up` is the
  /// upright axis, not zero.
  OrbitCamera(const core::Mesh& mesh, const Eigen::Vector3d& up, double room = 1);

  /// Dragging by an image's height turns by 180 degrees; the elevation stops at the poles.
  void orbit(const Eigen::Vector2d& drag_px, double image_height_px);
  /// The point under the cursor in the target's plane stays under it.
  void pan(const Eigen::Vector2d& drag_px, double image_height_px);
  /// Positive steps come nearer, 15 % each; never into the object's innermost thousandth.
  void zoom(double steps);
  /// Back to the whole object, seen from the present side.
  void frame();
  /// Takes the place of another camera, e.g. one of a recording, looking at the target.
  void stand_at(const Eigen::Vector3d& eye);

  [[nodiscard]] Eigen::Isometry3d camera_from_object() const;
  /// Without distortion, 35 degrees high.
  [[nodiscard]] static core::CameraModel lens(int width_px, int height_px);

  [[nodiscard]] const Eigen::Vector3d& object_centre() const { return object_centre_; }
  [[nodiscard]] double object_radius_m() const { return object_radius_m_; }
  /// Upright axis, unit length.
  [[nodiscard]] Eigen::Vector3d up() const { return object_from_upright_.col(2); }

 private:
  [[nodiscard]] Eigen::Vector3d towards_eye() const;
  [[nodiscard]] double farthest_m() const { return 50 * object_radius_m_; }

  Eigen::Matrix3d object_from_upright_;  ///< columns: two level axes and `up`
  Eigen::Vector3d object_centre_;
  double object_radius_m_ = 1;
  double room_ = 1;
  Eigen::Vector3d target_;
  double distance_m_ = 1;
  double azimuth_rad_ = -1.0;
  double elevation_rad_ = 0.5;
};

}  // namespace sheen::app
