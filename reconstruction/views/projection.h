// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <array>

namespace sheen::reconstruction {

/// One camera with its pose in single precision: board points to pixels, millions of them. The same
/// lens as core::CameraModel, OpenCV's pixel convention.
class Projection {
 public:
  Projection() = default;
  Projection(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_board);

  /// A point of the image and how deep it lies.
  struct Pixel {
    float x_px = 0;
    float y_px = 0;
    float depth_m = 0;  ///< along the optical axis; 0: behind the camera or beyond the lens model
    explicit operator bool() const { return depth_m > 0; }
  };

  /// `point` in the board frame, metres. The pixel may lie outside the image.
  [[nodiscard]] Pixel operator()(const Eigen::Vector3f& point) const {
    const Eigen::Vector3f p = turn_ * point + shift_;
    if (!(p.z() > 0)) return {};
    const float x = p.x() / p.z();
    const float y = p.y() / p.z();
    if (!(x * x + y * y <= largest_r2_)) return {};
    float u = 0;
    float v = 0;
    core::distort(lens_, k_.data(), x, y, u, v);
    return {focal_px_.x() * u + principal_px_.x(), focal_px_.y() * v + principal_px_.y(), p.z()};
  }

  /// Centre of the camera, board frame, metres.
  [[nodiscard]] const Eigen::Vector3f& eye() const { return eye_; }

  /// Unit vector along the optical axis, board frame.
  [[nodiscard]] Eigen::Vector3f forward() const { return turn_.row(2).transpose(); }

  /// Direction of the ray through a place (x, y) in the plane z = 1 of the camera frame, board
  /// frame; its length is that of (x, y, 1).
  [[nodiscard]] Eigen::Vector3f direction(float x, float y) const {
    return turn_.transpose() * Eigen::Vector3f(x, y, 1);
  }

  /// Pixels per metre across the line of sight at a depth.
  [[nodiscard]] float px_per_m(float depth_m) const { return mean_focal_px_ / depth_m; }

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  /// Whether a pixel lies at least `margin_px` within the centres of the outermost pixels.
  [[nodiscard]] bool in_image(const Pixel& pixel, float margin_px) const {
    return pixel.x_px >= margin_px && pixel.y_px >= margin_px &&
           pixel.x_px <= static_cast<float>(width_px_ - 1) - margin_px &&
           pixel.y_px <= static_cast<float>(height_px_ - 1) - margin_px;
  }

 private:
  Eigen::Matrix3f turn_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f eye_ = Eigen::Vector3f::Zero();
  Eigen::Vector2f focal_px_ = Eigen::Vector2f::Zero();
  Eigen::Vector2f principal_px_ = Eigen::Vector2f::Zero();
  std::array<float, 8> k_{};
  core::LensKind lens_ = core::LensKind::rational;
  float largest_r2_ = 0;
  float mean_focal_px_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
};

}  // namespace sheen::reconstruction
