// SPDX-License-Identifier: MIT
#include "core/alignment/projection_derivative.h"

#include "core/numerics/dual.h"

namespace sheen::core {
namespace {

/// Derivative of CameraModel::distort at `ideal`.
Eigen::Matrix2d distortion_derivative(const CameraModel::Intrinsics& intrinsics,
                                      const Eigen::Vector2d& ideal) {
  Dual u;
  Dual v;
  distort(intrinsics.lens, intrinsics.distortion.data(), Dual(ideal.x(), 1, 0),
          Dual(ideal.y(), 0, 1), u, v);
  Eigen::Matrix2d J;
  J << u.dx, u.dy, v.dx, v.dy;
  return J;
}

}  // namespace

std::optional<ProjectedPoint> project_with_derivative(const CameraModel& camera,
                                                      const Eigen::Vector3d& point_in_camera) {
  const auto pixel = camera.project(point_in_camera);
  if (!pixel) return std::nullopt;
  const auto& lens = camera.intrinsics();
  const double inverse_depth = 1 / point_in_camera.z();
  const Eigen::Vector2d ideal = point_in_camera.head<2>() * inverse_depth;
  Eigen::Matrix<double, 2, 3> ideal_by_point;
  ideal_by_point << inverse_depth, 0, -ideal.x() * inverse_depth,  //
      0, inverse_depth, -ideal.y() * inverse_depth;
  return ProjectedPoint{
      *pixel, lens.focal_px.asDiagonal() * (distortion_derivative(lens, ideal) * ideal_by_point)};
}

Eigen::Matrix<double, 2, 6> pixel_by_twist(const Eigen::Matrix<double, 2, 3>& pixel_by_point,
                                           const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 2, 6> by_twist;
  for (int axis = 0; axis < 3; ++axis) {
    by_twist.col(axis) = pixel_by_point * Eigen::Vector3d::Unit(axis).cross(arm);
  }
  by_twist.rightCols<3>() = pixel_by_point;
  return by_twist;
}

}  // namespace sheen::core
