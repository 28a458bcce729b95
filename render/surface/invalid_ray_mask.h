// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

namespace sheen::render {

/// Pixels that no ray of the lens model reaches (CameraModel::unproject has no answer), which a
/// rasteriser must leave black: CV_8UC1, 255 where invalid; empty when there are none, as for any
/// camera whose corners see something. Remembers the last camera.
class InvalidRayMask {
 public:
  const cv::Mat& of(const core::CameraModel& camera);

 private:
  core::CameraModel camera_;
  cv::Mat mask_;
};

}  // namespace sheen::render
