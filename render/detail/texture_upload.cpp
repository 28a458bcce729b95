// SPDX-License-Identifier: MIT
#include "render/detail/texture_upload.h"

#include "core/diagnostics/error.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <string>

namespace sheen::render::detail {
namespace {

core::Error too_large(const core::Atlas& atlas, const std::string& fault) {
  return {core::Error::Kind::run_failed,
          "texture of " + std::to_string(atlas.width) + " x " + std::to_string(atlas.height) +
              " texels",
          fault, "use larger texels (--texel-mm)"};
}

}  // namespace

TextureUpload::TextureUpload(const gl::Functions& gl, const fitting::SurfaceTexture& texture)
    : gl_(gl), texture_(texture) {
  const core::Atlas& atlas = texture.atlas();
  const int limit = gl::integer_limit(gl, GL_MAX_TEXTURE_SIZE);
  if (std::max(atlas.width, atlas.height) > limit) {
    throw too_large(atlas, "is larger than this OpenGL driver holds, " + std::to_string(limit));
  }
  name_ = gl::make_texture(gl, GL_TEXTURE_2D);
  gl_.TextureStorage2D(name_.name(), 1, GL_RGB8, atlas.width, atlas.height);
  if (gl_.GetError() == GL_OUT_OF_MEMORY) {
    throw too_large(atlas, "needs more memory than this OpenGL driver has");
  }
  gl_.TextureParameteri(name_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  send(cv::Rect(0, 0, atlas.width, atlas.height));
}

std::size_t TextureUpload::send(std::size_t page_idx) const {
  return send(texture_.page(page_idx));
}

std::size_t TextureUpload::send(const cv::Rect& part) const {
  const int width = texture_.atlas().width;
  const std::size_t first = static_cast<std::size_t>(part.y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(part.x);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.PixelStorei(GL_UNPACK_ROW_LENGTH, width);
  gl_.TextureSubImage2D(name_.name(), 0, part.x, part.y, part.width, part.height, GL_RGB,
                        GL_UNSIGNED_BYTE, texture_.texels().data() + first);
  gl_.PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  return static_cast<std::size_t>(part.area()) * sizeof(fitting::Texel);
}

}  // namespace sheen::render::detail
