// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

namespace sheen::core {

/// Images of a camera as a camera without distortion would have taken them, of the same focal
/// length, principal point and size.
class Undistortion {
 public:
  explicit Undistortion(const CameraModel& camera);

  [[nodiscard]] const CameraModel& camera() const { return camera_; }  ///< without distortion

  /// CV_8UC3 -> CV_8UC3; black where the distorted image ends.
  [[nodiscard]] cv::Mat image(const cv::Mat& distorted) const;

  /// CV_8UC1: 255 where the distorted image has something to show.
  [[nodiscard]] const cv::Mat& covered() const { return covered_; }

 private:
  CameraModel camera_;
  cv::Mat places_;  ///< CV_32FC2: of each pixel in the distorted image
  cv::Mat covered_;
};

}  // namespace sheen::core
