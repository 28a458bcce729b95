// SPDX-License-Identifier: MIT
#include "capture/pose/rolling_shutter.h"

namespace sheen::capture {

Eigen::Vector3d when_its_row_is_read(const core::CameraModel& camera, const Twist& readout_motion,
                                     const Eigen::Vector3d& point_in_camera) {
  if (readout_motion.isZero()) return point_in_camera;
  // Each round divides the error by the image's height over its motion in pixels: 20 and more.
  constexpr int rounds = 3;
  Eigen::Vector3d point = point_in_camera;
  for (int round = 0; round < rounds; ++round) {
    const auto px = camera.project(point);
    if (!px) return point_in_camera;
    point = moved_by(readout_motion, row_share(px->y(), camera.height_px()), point_in_camera);
  }
  return point;
}

Twist twist_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::Isometry3d motion = to * from.inverse();
  const Eigen::AngleAxisd turn(motion.linear());
  Twist twist;
  twist << turn.angle() * turn.axis(), motion.translation();
  return twist;
}

}  // namespace sheen::capture
