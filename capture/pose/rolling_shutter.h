// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "core/geometry/camera.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sheen::capture {

// A rolling shutter reads its rows one after the other. A frame's pose is that of its middle; while
// the frame is read the board goes on by `readout_motion`, a twist in the camera frame from the
// first row to the last (docs/algorithm.md, 10). Zero for a global shutter.

/// When a row is read, as a share of the readout, from -0.5 at the upper edge of the image to 0.5
/// at the lower. `y_px` may lie outside.
inline double row_share(double y_px, int height_px) {
  return (y_px + 0.5) / height_px - 0.5;
}

/// `point_in_camera` (metres) after a share of the motion, to first order.
inline Eigen::Vector3d moved_by(const Twist& motion, double share,
                                const Eigen::Vector3d& point_in_camera) {
  return point_in_camera + share * (motion.head<3>().cross(point_in_camera) + motion.tail<3>());
}

/// Where a point, at `point_in_camera` (metres) at the middle of the readout, is when the row that
/// shows it is read. The point itself where the camera does not see it.
Eigen::Vector3d when_its_row_is_read(const core::CameraModel& camera, const Twist& readout_motion,
                                     const Eigen::Vector3d& point_in_camera);

/// The twist by which `moved` takes one pose to the other.
Twist twist_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

}  // namespace sheen::capture
