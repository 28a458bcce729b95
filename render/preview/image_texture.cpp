// SPDX-License-Identifier: MIT
#include "render/preview/image_texture.h"

#include <cassert>

namespace sheen::render {

void ImageTexture::upload(const cv::Mat& image) {
  assert(image.type() == CV_8UC3 && !image.empty());
  if (image.size() != size_) {
    texture_ = gl::make_texture(gl_, GL_TEXTURE_2D);
    gl_.TextureStorage2D(texture_.name(), 1, GL_RGBA8, image.cols, image.rows);
    gl_.TextureParameteri(texture_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TextureParameteri(texture_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TextureParameteri(texture_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_.TextureParameteri(texture_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    size_ = image.size();
  }
  // Rows of a part of a larger image are further apart than their pixels say.
  const cv::Mat rows = image.isContinuous() ? image : image.clone();
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.TextureSubImage2D(texture_.name(), 0, 0, 0, rows.cols, rows.rows, GL_BGR, GL_UNSIGNED_BYTE,
                        rows.data);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

}  // namespace sheen::render
