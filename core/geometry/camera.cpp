// SPDX-License-Identifier: MIT
#include "core/geometry/camera.h"

#include <Eigen/LU>

#include <cmath>

namespace sheen::core {
namespace {

constexpr double kWidestRadius = 6.0;  // tan(80.5 degrees): no lens of this model is wider

double radial_factor(const std::array<double, 8>& k, double r2) {
  return (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

/// First radius at which r * radial_factor(r) stops growing.
double find_valid_radius(const std::array<double, 8>& k) {
  constexpr double step = 0.002;
  double previous = 0;
  for (double r = step; r < kWidestRadius; r += step) {
    const double distorted = r * radial_factor(k, r * r);
    if (!(distorted > previous)) return r - step;
    previous = distorted;
  }
  return kWidestRadius;
}

}  // namespace

CameraModel::CameraModel(const Intrinsics& intrinsics)
    : intrinsics_(intrinsics), valid_radius_(find_valid_radius(intrinsics.distortion)) {}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& ideal) const {
  const auto& k = intrinsics_.distortion;
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const double radial = radial_factor(k, r2);
  return {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
          y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& distorted) const {
  constexpr int max_steps = 30;
  constexpr double tolerance = 1e-12;
  constexpr double h = 1e-6;
  Eigen::Vector2d ideal = distorted;
  if (ideal.norm() > valid_radius_) ideal *= valid_radius_ / ideal.norm();
  for (int step = 0; step < max_steps; ++step) {
    const Eigen::Vector2d residual = distort(ideal) - distorted;
    if (residual.squaredNorm() < tolerance * tolerance) break;
    Eigen::Matrix2d J;
    J.col(0) =
        (distort(ideal + Eigen::Vector2d(h, 0)) - distort(ideal - Eigen::Vector2d(h, 0))) / (2 * h);
    J.col(1) =
        (distort(ideal + Eigen::Vector2d(0, h)) - distort(ideal - Eigen::Vector2d(0, h))) / (2 * h);
    if (std::abs(J.determinant()) < 1e-9) return std::nullopt;
    ideal -= J.inverse() * residual;
    // Stay inside the branch of the polynomial that grows.
    if (ideal.norm() > valid_radius_) ideal *= valid_radius_ / ideal.norm();
  }
  if ((distort(ideal) - distorted).norm() > 1e-8) return std::nullopt;
  return ideal;
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& point_in_camera) const {
  if (!(point_in_camera.z() > 0)) return std::nullopt;
  const Eigen::Vector2d ideal = point_in_camera.head<2>() / point_in_camera.z();
  if (!(ideal.norm() <= valid_radius_)) return std::nullopt;
  return Eigen::Vector2d(distort(ideal).cwiseProduct(intrinsics_.focal_px) +
                         intrinsics_.principal_px);
}

std::optional<Eigen::Vector3d> CameraModel::unproject(const Eigen::Vector2d& pixel) const {
  const auto ideal =
      undistort((pixel - intrinsics_.principal_px).cwiseQuotient(intrinsics_.focal_px));
  if (!ideal) return std::nullopt;
  return Eigen::Vector3d(ideal->x(), ideal->y(), 1.0);
}

}  // namespace sheen::core
