// SPDX-License-Identifier: MIT
#include "render/gl/offscreen_target.h"

#include "core/diagnostics/error.h"

#include <cassert>
#include <string>
#include <utility>

namespace sheen::render::gl {
namespace {

core::Error failure(int width_px, int height_px) {
  return {core::Error::Kind::run_failed,
          "image of " + std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels",
          "cannot be drawn by this OpenGL driver", "use smaller images"};
}

Texture make_plane(const Functions& gl, GLenum format, int width_px, int height_px) {
  Texture plane = make_texture(gl, GL_TEXTURE_2D);
  gl.TextureStorage2D(plane.name(), 1, format, width_px, height_px);
  return plane;
}

}  // namespace

OffscreenTarget::OffscreenTarget(const Functions& gl, Colour kind) : gl_(gl), kind_(kind) {}

GLuint OffscreenTarget::framebuffer(int width_px, int height_px) {
  if (width_px == width_px_ && height_px == height_px_) return framebuffer_.name();
  const int limit = integer_limit(gl_, GL_MAX_TEXTURE_SIZE);
  if (width_px < 1 || height_px < 1 || width_px > limit || height_px > limit) {
    throw failure(width_px, height_px);
  }

  // Make the planes and join them; the old ones go only once the new ones are complete.
  Framebuffer made = make_framebuffer(gl_);
  Texture depth = make_plane(gl_, GL_DEPTH_COMPONENT32F, width_px, height_px);
  gl_.NamedFramebufferTexture(made.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  Texture colour;
  if (kind_ != Colour::none) {
    const GLenum format = kind_ == Colour::bytes ? GL_RGBA8 : GL_RGBA32F;
    colour = make_plane(gl_, format, width_px, height_px);
    gl_.TextureParameteri(colour.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TextureParameteri(colour.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_.TextureParameteri(colour.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl_.NamedFramebufferTexture(made.name(), GL_COLOR_ATTACHMENT0, colour.name(), 0);
  }
  if (gl_.CheckNamedFramebufferStatus(made.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw failure(width_px, height_px);
  }
  framebuffer_ = std::move(made);
  depth_ = std::move(depth);
  colour_ = std::move(colour);
  width_px_ = width_px;
  height_px_ = height_px;
  return framebuffer_.name();
}

void OffscreenTarget::replace(const cv::Mat& rgba) {
  assert(kind_ == Colour::bytes && rgba.type() == CV_8UC4 && rgba.isContinuous());
  framebuffer(rgba.cols, rgba.rows);
  gl_.TextureSubImage2D(colour_.name(), 0, 0, 0, rgba.cols, rgba.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                        rgba.data);
}

}  // namespace sheen::render::gl
