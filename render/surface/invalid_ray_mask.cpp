// SPDX-License-Identifier: MIT
#include "render/surface/invalid_ray_mask.h"

#include <array>

namespace sheen::render {
namespace {

bool corners_see(const core::CameraModel& camera) {
  for (const double x : {0.0, camera.width_px() - 1.0}) {
    for (const double y : {0.0, camera.height_px() - 1.0}) {
      if (!camera.unproject({x, y})) return false;
    }
  }
  return true;
}

}  // namespace

const cv::Mat& InvalidRayMask::of(const core::CameraModel& camera) {
  if (camera.intrinsics() == camera_.intrinsics()) return mask_;
  camera_ = camera;
  mask_.release();
  if (corners_see(camera)) return mask_;
  mask_.create(camera.height_px(), camera.width_px(), CV_8UC1);
  for (int y = 0; y < mask_.rows; ++y) {
    for (int x = 0; x < mask_.cols; ++x) {
      mask_.at<std::uint8_t>(y, x) = camera.unproject({x, y}) ? 0 : 255;
    }
  }
  return mask_;
}

}  // namespace sheen::render
