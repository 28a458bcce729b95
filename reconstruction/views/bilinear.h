// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>

namespace sheen::reconstruction {

/// Bilinear value of a CV_8UC3 image, in [0, 1]; the place must lie within the centres of the
/// outermost pixels, less one at the right and at the bottom.
inline cv::Vec3f bilinear_bgr(const cv::Mat& image, float x_px, float y_px) {
  const int x = static_cast<int>(x_px);
  const int y = static_cast<int>(y_px);
  const float fx = x_px - static_cast<float>(x);
  const float fy = y_px - static_cast<float>(y);
  const std::uint8_t* upper = image.ptr<std::uint8_t>(y) + 3 * x;
  const std::uint8_t* lower = upper + image.step;
  const float w11 = fx * fy;
  const float w10 = fy - w11;
  const float w01 = fx - w11;
  const float w00 = 1 - fx - w10;
  constexpr float unit = 1.0F / 255;
  cv::Vec3f value;
  for (int c = 0; c < 3; ++c) {
    value[c] = unit * (w00 * upper[c] + w01 * upper[c + 3] + w10 * lower[c] + w11 * lower[c + 3]);
  }
  return value;
}

/// Bilinear value of a CV_32FC1 image; the same rule.
inline float bilinear_value(const cv::Mat& image, float x_px, float y_px) {
  const int x = static_cast<int>(x_px);
  const int y = static_cast<int>(y_px);
  const float fx = x_px - static_cast<float>(x);
  const float fy = y_px - static_cast<float>(y);
  const float* upper = image.ptr<float>(y) + x;
  const float* lower = image.ptr<float>(y + 1) + x;
  return (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) +
         fy * ((1 - fx) * lower[0] + fx * lower[1]);
}

}  // namespace sheen::reconstruction
