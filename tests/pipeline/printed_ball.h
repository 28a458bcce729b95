// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

namespace sheen::pipeline::test {

constexpr double kBallRadius_m = 0.05;

/// Latitudes and longitudes, its middle at the origin.
core::Mesh ball();

/// How it is photographed.
struct BallPhotograph {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< where the ball is
  bool is_glossy = false;                              ///< a highlight goes with the camera
  cv::Vec3b background = cv::Vec3b::all(60);           ///< BGR
  double halo = 0;  ///< ring of the ball's mean colour round its image, a part of its radius
};

/// The ball, drawn by rays, with a print that has detail of some millimetres in every direction.
cv::Mat photograph(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                   const BallPhotograph& how);

}  // namespace sheen::pipeline::test
