// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/owners.h"

#include <opencv2/core/mat.hpp>

namespace sheen::render::gl {

/// Colour plane of a framebuffer: none, RGBA8 for images, or RGBA32F for sums.
enum class Colour { none, bytes, floats };

/// Framebuffer with a 32-bit float depth buffer and, if wanted, colour, of the size last asked for.
class OffscreenTarget {
 public:
  OffscreenTarget(const Functions& gl, Colour kind);

  /// Framebuffer of this size, contents unspecified after a change of size. The context is
  /// current. Throws core::Error (run_failed) for sizes the driver cannot make.
  GLuint framebuffer(int width_px, int height_px);

  /// Becomes an image, CV_8UC4 in the order R, G, B, A; for targets of bytes.
  void replace(const cv::Mat& rgba);

  /// Colour plane of the framebuffer last returned, for drawing it elsewhere; 0 without one.
  [[nodiscard]] GLuint colour_texture() const { return colour_.name(); }

 private:
  const Functions& gl_;
  Colour kind_;
  int width_px_ = 0;
  int height_px_ = 0;
  Texture colour_;
  Texture depth_;
  Framebuffer framebuffer_;
};

}  // namespace sheen::render::gl
