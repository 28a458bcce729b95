// SPDX-License-Identifier: MIT
#pragma once

#include "capture/synthetic/scene.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace sheen::capture::synthetic {

/// What falls on the sensor in one exposure.
struct Exposure {
  cv::Mat light;   ///< CV_32FC3, linear R, G, B; 1 = white, may exceed it
  cv::Mat object;  ///< CV_32FC1: share of the pixel that the object covers
};

/// A camera with a real lens: rays through every pixel, distortion included.
class RenderCamera {
 public:
  explicit RenderCamera(const core::CameraModel& camera);

  /// Averages `samples` rays over the square of every pixel (box filter, a shifted low-discrepancy
  /// set per pixel). `board_from_camera` is one pose for all rows, or one for each of a rolling
  /// shutter. The result does not depend on `threads`.
  [[nodiscard]] Exposure expose(const Scene& scene,
                                std::span<const Eigen::Isometry3d> board_from_camera, int samples,
                                std::uint32_t seed, int threads) const;
  [[nodiscard]] Exposure expose(const Scene& scene, const Eigen::Isometry3d& board_from_camera,
                                int samples, std::uint32_t seed, int threads) const {
    return expose(scene, {&board_from_camera, 1}, samples, seed, threads);
  }

  /// Depth along the optical axis of what the middle of every pixel shows, metres: CV_32FC1, 0
  /// where nothing is. The result does not depend on `threads`.
  [[nodiscard]] cv::Mat depth_m(const Scene& scene, const Eigen::Isometry3d& board_from_camera,
                                int threads) const;

 private:
  /// Ray through a place inside pixel (x, y), `fx` and `fy` in [0, 1) from its upper left corner.
  [[nodiscard]] Eigen::Vector3f ray(int x, int y, float fx, float fy) const;

  int width_px_;
  int height_px_;
  std::vector<Eigen::Vector2f> corners_;  ///< z = 1 positions of the pixels' corners, row-major
};

/// Noise of a sensor: standard deviation sqrt(read^2 + shot * light) of the linear value.
struct SensorNoise {
  float read = 0.0025f;
  float shot = 0.0004f;
};
inline constexpr SensorNoise kNoNoise{0, 0};

/// Exposure -> 8-bit sRGB image, CV_8UC3 in OpenCV's BGR order. `seed` decides the noise.
cv::Mat develop(const cv::Mat& light, const SensorNoise& noise, std::uint32_t seed);

}  // namespace sheen::capture::synthetic
