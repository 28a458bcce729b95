// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/owners.h"

#include <opencv2/core/mat.hpp>

namespace sheen::render {

/// A camera's image as a texture. The context is current in all calls.
class ImageTexture {
 public:
  explicit ImageTexture(const gl::Functions& gl) : gl_(gl) {}

  /// Sends an image, CV_8UC3 BGR, not empty; a new size makes a new texture.
  void upload(const cv::Mat& image);

  /// 0 before the first image.
  [[nodiscard]] GLuint name() const { return texture_.name(); }

 private:
  const gl::Functions& gl_;
  cv::Size size_;
  gl::Texture texture_;
};

}  // namespace sheen::render
