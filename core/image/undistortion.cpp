// SPDX-License-Identifier: MIT
#include "core/image/undistortion.h"

#include <opencv2/imgproc.hpp>

namespace sheen::core {

Undistortion::Undistortion(const CameraModel& camera) {
  CameraModel::Intrinsics straight = camera.intrinsics();
  straight.distortion = {};
  straight.lens = LensKind::rational;  // a fisheye without coefficients still bends lines
  camera_ = CameraModel(straight);
  const cv::Size size(camera.width_px(), camera.height_px());
  places_ = cv::Mat(size, CV_32FC2, cv::Scalar(-1, -1));
  covered_ = cv::Mat::zeros(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto ray = camera_.unproject({x, y});
      const auto pixel = ray ? camera.project(*ray) : std::nullopt;
      if (!pixel) continue;
      places_.at<cv::Vec2f>(y, x) = {static_cast<float>(pixel->x()),
                                     static_cast<float>(pixel->y())};
      const bool is_inside = pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() <= size.width - 1 &&
                             pixel->y() <= size.height - 1;
      covered_.at<std::uint8_t>(y, x) = is_inside ? 255 : 0;
    }
  }
}

cv::Mat Undistortion::image(const cv::Mat& distorted) const {
  cv::Mat straight;
  cv::remap(distorted, straight, places_, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  straight.setTo(cv::Scalar::all(0), covered_ == 0);
  return straight;
}

}  // namespace sheen::core
