// SPDX-License-Identifier: MIT
#include "render/views/read_view.h"

#include <opencv2/core.hpp>

#include <array>
#include <cstdint>

namespace sheen::render {

RenderedView read_view(const gl::Functions& gl, const cv::Size& size_px) {
  // Four bytes per pixel, so rows need no padding.
  cv::Mat pixels(size_px, CV_8UC4);
  gl.ReadPixels(0, 0, pixels.cols, pixels.rows, GL_BGRA, GL_UNSIGNED_BYTE, pixels.data);
  constexpr std::uint8_t supported = 255;
  RenderedView view;
  view.image.create(pixels.size(), CV_8UC3);
  cv::Mat alpha(pixels.size(), CV_8UC1);
  std::array<cv::Mat, 2> planes{view.image, alpha};
  constexpr std::array<int, 8> from_to{0, 0, 1, 1, 2, 2, 3, 3};
  cv::mixChannels(&pixels, 1, planes.data(), planes.size(), from_to.data(), 4);
  cv::compare(alpha, 0, view.mask, cv::CMP_GT);
  cv::compare(alpha, supported, view.support, cv::CMP_EQ);
  return view;
}

}  // namespace sheen::render
