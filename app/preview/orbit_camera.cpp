// SPDX-License-Identifier: MIT
#include "app/preview/orbit_camera.h"

#include "core/mesh/bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::app {
namespace {

constexpr double kHalfHeightTangent = 0.3153;  // tan(35 degrees / 2)
constexpr double kHighest_rad = 1.5607;        // half a degree short of the pole
constexpr double kFill = 0.86;                 // share of the image that the object's sphere takes
constexpr double kZoomStep = 0.85;

/// Right-handed axes whose third is `up`.
Eigen::Matrix3d upright_axes(const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = up.normalized();
  const Eigen::Vector3d helper =
      std::abs(z.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix3d axes;
  axes.col(2) = z;
  axes.col(0) = (helper - helper.dot(z) * z).normalized();
  axes.col(1) = z.cross(axes.col(0));
  return axes;
}

}  // namespace

OrbitCamera::OrbitCamera(const core::Mesh& mesh, const Eigen::Vector3d& up, double room)
    : object_from_upright_(upright_axes(up)), room_(room) {
  const Eigen::AlignedBox3f box = core::bounds_of(mesh);
  object_centre_ = box.center().cast<double>();
  float radius = 0;
  for (const Eigen::Vector3f& position : mesh.positions) {
    radius = std::max(radius, (position - box.center()).norm());
  }
  object_radius_m_ = std::max(static_cast<double>(radius), 1e-6);
  frame();
}

void OrbitCamera::orbit(const Eigen::Vector2d& drag_px, double image_height_px) {
  const Eigen::Vector2d turn = drag_px * (std::numbers::pi / image_height_px);
  azimuth_rad_ = std::remainder(azimuth_rad_ - turn.x(), 2 * std::numbers::pi);
  elevation_rad_ = std::clamp(elevation_rad_ + turn.y(), -kHighest_rad, kHighest_rad);
}

void OrbitCamera::pan(const Eigen::Vector2d& drag_px, double image_height_px) {
  const double metres_per_px = 2 * kHalfHeightTangent * distance_m_ / image_height_px;
  const Eigen::Matrix3d object_from_camera = camera_from_object().linear().transpose();
  target_ -= metres_per_px *
             (drag_px.x() * object_from_camera.col(0) + drag_px.y() * object_from_camera.col(1));
}

void OrbitCamera::zoom(double steps) {
  distance_m_ =
      std::clamp(distance_m_ * std::pow(kZoomStep, steps), 1e-3 * object_radius_m_, farthest_m());
}

void OrbitCamera::frame() {
  target_ = object_centre_;
  // The sphere's silhouette touches a cone whose half-angle has this sine.
  distance_m_ = room_ * object_radius_m_ / (kFill * std::sin(std::atan(kHalfHeightTangent)));
}

void OrbitCamera::stand_at(const Eigen::Vector3d& eye) {
  const Eigen::Vector3d way = object_from_upright_.transpose() * (eye - target_);
  const double distance = way.norm();
  if (distance < 1e-3 * object_radius_m_) return;
  distance_m_ = std::min(distance, farthest_m());
  azimuth_rad_ = std::atan2(way.y(), way.x());
  elevation_rad_ = std::clamp(std::asin(way.z() / distance), -kHighest_rad, kHighest_rad);
}

Eigen::Vector3d OrbitCamera::towards_eye() const {
  return object_from_upright_ * Eigen::Vector3d(std::cos(elevation_rad_) * std::cos(azimuth_rad_),
                                                std::cos(elevation_rad_) * std::sin(azimuth_rad_),
                                                std::sin(elevation_rad_));
}

Eigen::Isometry3d OrbitCamera::camera_from_object() const {
  const Eigen::Vector3d back = towards_eye();
  Eigen::Matrix3d camera_axes;  // rows: right, down, forward in the object frame
  camera_axes.row(2) = -back.transpose();
  camera_axes.row(0) = up().cross(back).normalized().transpose();
  camera_axes.row(1) = camera_axes.row(2).cross(camera_axes.row(0));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = camera_axes;
  pose.translation() = -camera_axes * (target_ + distance_m_ * back);
  return pose;
}

core::CameraModel OrbitCamera::lens(int width_px, int height_px) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = width_px;
  intrinsics.height_px = height_px;
  intrinsics.focal_px.setConstant(0.5 * height_px / kHalfHeightTangent);
  intrinsics.principal_px = Eigen::Vector2d(0.5 * (width_px - 1), 0.5 * (height_px - 1));
  return core::CameraModel(intrinsics);
}

}  // namespace sheen::app
