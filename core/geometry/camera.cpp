// SPDX-License-Identifier: MIT
#include "core/geometry/camera.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace sheen::core {
namespace {

Eigen::Vector2d distorted_by(const CameraModel::Intrinsics& intrinsics,
                             const Eigen::Vector2d& ideal) {
  Eigen::Vector2d moved;
  distort(intrinsics.lens, intrinsics.distortion.data(), ideal.x(), ideal.y(), moved.x(),
          moved.y());
  return moved;
}

/// How far the radial part of the lens moves a point at this radius.
double radial_position(const CameraModel::Intrinsics& intrinsics, double radius) {
  CameraModel::Intrinsics radial = intrinsics;
  if (radial.lens == LensKind::rational) radial.distortion[2] = radial.distortion[3] = 0;
  return distorted_by(radial, {radius, 0}).x();
}

/// First radius at which the radial part stops growing.
double find_valid_radius(const CameraModel::Intrinsics& intrinsics) {
  constexpr double step = 0.002;
  const double widest = traits_of(intrinsics.lens).widest_radius;
  double previous = 0;
  for (double r = step; r < widest; r += step) {
    const double distorted = radial_position(intrinsics, r);
    if (!(distorted > previous)) return r - step;
    previous = distorted;
  }
  return widest;
}

/// Where the search for the inverse begins: wide lenses move points too far for Newton's steps to
/// find back from there, so the radius is bisected.
Eigen::Vector2d first_ideal(const CameraModel::Intrinsics& intrinsics, double valid_radius,
                            const Eigen::Vector2d& distorted) {
  const double wanted = distorted.norm();
  if (intrinsics.lens == LensKind::rational || wanted < 1e-9) return distorted;
  double low = 0;
  double high = valid_radius;
  for (int step = 0; step < 40; ++step) {
    const double middle = (low + high) / 2;
    (radial_position(intrinsics, middle) < wanted ? low : high) = middle;
  }
  return distorted * (low / wanted);
}

}  // namespace

CameraModel::CameraModel(const Intrinsics& intrinsics)
    : intrinsics_(intrinsics), valid_radius_(find_valid_radius(intrinsics)) {}

bool CameraModel::curves_lines() const {
  const auto& k = intrinsics_.distortion;
  return intrinsics_.lens != LensKind::rational ||
         std::any_of(k.begin(), k.end(), [](double value) { return value != 0; });
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& ideal) const {
  return distorted_by(intrinsics_, ideal);
}

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& distorted) const {
  constexpr int max_steps = 30;
  constexpr double tolerance = 1e-12;
  constexpr double h = 1e-6;
  Eigen::Vector2d ideal = first_ideal(intrinsics_, valid_radius_, distorted);
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
