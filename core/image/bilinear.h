// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <array>
#include <cstdint>

namespace sheen::core {

/// Bilinear colour of a CV_8UC3 image (BGR) at a place in pixels: RGB, 0 to 255. The four pixels
/// around it exist.
inline std::array<float, 3> bilinear_rgb(const cv::Mat& image, const Eigen::Vector2f& at_px) {
  const auto x = static_cast<int>(at_px.x());
  const auto y = static_cast<int>(at_px.y());
  const float right = at_px.x() - static_cast<float>(x);
  const float below = at_px.y() - static_cast<float>(y);
  const std::uint8_t* const upper = image.ptr<std::uint8_t>(y) + 3 * x;
  const std::uint8_t* const lower = upper + image.step[0];
  const auto channel = [&](int c) {
    const float above =
        (1 - right) * static_cast<float>(upper[c]) + right * static_cast<float>(upper[c + 3]);
    const float under =
        (1 - right) * static_cast<float>(lower[c]) + right * static_cast<float>(lower[c + 3]);
    return (1 - below) * above + below * under;
  };
  return {channel(2), channel(1), channel(0)};
}

}  // namespace sheen::core
