// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <algorithm>

namespace sheen::render {

/// Reads an image (CV_8UC3) between its pixels, bilinearly; beyond its border what lies on it.
/// (0, 0) is the middle of the first pixel. Channels in the image's order, 0 to 255.
inline Eigen::Vector3f read_between(const cv::Mat& image, float x_px, float y_px) {
  const float x = std::clamp(x_px, 0.0f, static_cast<float>(image.cols - 1));
  const float y = std::clamp(y_px, 0.0f, static_cast<float>(image.rows - 1));
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int right = std::min(left + 1, image.cols - 1);
  const int bottom = std::min(top + 1, image.rows - 1);
  const float u = x - static_cast<float>(left);
  const float v = y - static_cast<float>(top);
  const auto* const upper = image.ptr<cv::Vec3b>(top);
  const auto* const lower = image.ptr<cv::Vec3b>(bottom);
  Eigen::Vector3f colour;
  for (int c = 0; c < 3; ++c) {
    const float above =
        static_cast<float>(upper[left][c]) * (1 - u) + static_cast<float>(upper[right][c]) * u;
    const float below =
        static_cast<float>(lower[left][c]) * (1 - u) + static_cast<float>(lower[right][c]) * u;
    colour[c] = above * (1 - v) + below * v;
  }
  return colour;
}

}  // namespace sheen::render
