// SPDX-License-Identifier: MIT
#include "core/alignment/projection_derivative.h"

namespace sheen::core {
namespace {

/// Derivative of CameraModel::distort at `ideal`.
Eigen::Matrix2d distortion_derivative(const std::array<double, 8>& k,
                                      const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const double upper = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double lower = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double upper_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double lower_slope = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  const double radial = upper / lower;
  const double slope = (upper_slope - radial * lower_slope) / lower;  // of `radial` by r2
  const double mixed = 2 * x * y * slope + 2 * k[2] * x + 2 * k[3] * y;
  Eigen::Matrix2d J;
  J << radial + 2 * x * x * slope + 2 * k[2] * y + 6 * k[3] * x, mixed,  //
      mixed, radial + 2 * y * y * slope + 6 * k[2] * y + 2 * k[3] * x;
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
  return ProjectedPoint{*pixel,
                        lens.focal_px.asDiagonal() *
                            (distortion_derivative(lens.distortion, ideal) * ideal_by_point)};
}

}  // namespace sheen::core
