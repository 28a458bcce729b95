// SPDX-License-Identifier: MIT
#include "render/billboard/frame_layers.h"

#include "core/diagnostics/error.h"
#include "render/billboard/frame_pyramid.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <string>

namespace sheen::render {
namespace {

constexpr std::size_t kBytesPerMegabyte = 1000000;

/// A frame with all its levels, 16 bits a channel, and its shape.
std::size_t bytes_per_layer(int side_px) {
  const auto pixels = static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px);
  return 4 * pixels + 8 * pixels * 4 / 3;
}

}  // namespace

FrameLayers::FrameLayers(const gl::Functions& gl, const fitting::billboard::Billboards& billboards)
    : gl_(gl), billboards_(billboards), layer_of_(billboards.element_count(), kNowhere) {
  const auto& options = billboards.options();
  const std::size_t budget = static_cast<std::size_t>(options.views.cache_mb) * kBytesPerMegabyte;
  const std::size_t most = budget / bytes_per_layer(options.side_px);
  const auto limit = static_cast<std::size_t>(gl::integer_limit(gl, GL_MAX_ARRAY_TEXTURE_LAYERS));
  make_layers(std::clamp<std::size_t>(most, 1, std::min(billboards.element_count(), limit)));
}

void FrameLayers::make_layers(std::size_t count) {
  const int side_px = billboards_.options().side_px;
  int levels = 1;
  while (side_px >> levels > 0) ++levels;
  const auto depth = static_cast<GLsizei>(count);
  colours_ = gl::make_texture(gl_, GL_TEXTURE_2D_ARRAY);
  gl_.TextureStorage3D(colours_.name(), levels, GL_RGBA16, side_px, side_px, depth);
  shapes_ = gl::make_texture(gl_, GL_TEXTURE_2D_ARRAY);
  gl_.TextureStorage3D(shapes_.name(), 1, GL_RGBA8UI, side_px, side_px, depth);
  if (depth > gl::integer_limit(gl_, GL_MAX_ARRAY_TEXTURE_LAYERS) ||
      gl_.GetError() == GL_OUT_OF_MEMORY) {
    throw core::Error(
        core::Error::Kind::run_failed, std::to_string(count) + " frames",
        "are more than this OpenGL driver holds",
        "make the model with a smaller --billboard-size or --image-cache-mb, or draw fewer copies");
  }
  // Shaders fetch single texels, and whole numbers cannot be read between.
  for (const gl::Texture* const texture : {&colours_, &shapes_}) {
    gl_.TextureParameteri(texture->name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    gl_.TextureParameteri(texture->name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  layers_.assign(count, {});
  forget();
}

void FrameLayers::forget() {
  std::ranges::fill(layers_, Layer{});
  std::ranges::fill(layer_of_, kNowhere);
}

void FrameLayers::hold(std::span<const std::size_t> frames) {
  if (frames.size() > layers_.size()) make_layers(frames.size());
  ++calls_;
  std::vector<std::size_t> missing;
  for (const std::size_t frame_idx : frames) {
    const int layer = layer_of_[frame_idx];
    if (layer == kNowhere) {
      missing.push_back(frame_idx);
    } else {
      layers_[static_cast<std::size_t>(layer)].last_needed = calls_;
    }
  }
  for (const std::size_t frame_idx : missing) {
    const auto oldest = std::ranges::min_element(layers_, {}, &Layer::last_needed);
    if (oldest->frame_idx != kEmpty) layer_of_[oldest->frame_idx] = kNowhere;
    const auto layer = static_cast<int>(oldest - layers_.begin());
    send(frame_idx, layer);
    *oldest = {frame_idx, calls_};
    layer_of_[frame_idx] = layer;
  }
}

void FrameLayers::send(std::size_t frame_idx, int layer) {
  const auto frame = fitting::billboard::decode(billboards_.frame(frame_idx));
  const int side_px = billboards_.options().side_px;
  const FramePyramid pyramid(frame, side_px);

  // 0 to 255 and coverage 0 to 1, of 16 bits.
  constexpr double whole = 65535;
  GLint level = 0;
  for (const cv::Mat& image : pyramid.levels()) {
    cv::Mat sixteen_bits;
    cv::multiply(image, cv::Scalar(whole / 255, whole / 255, whole / 255, whole), sixteen_bits, 1,
                 CV_16U);
    gl_.TextureSubImage3D(colours_.name(), level++, 0, 0, layer, image.cols, image.rows, 1, GL_BGRA,
                          GL_UNSIGNED_SHORT, sixteen_bits.data);
  }
  cv::Mat shape(side_px, side_px, CV_8UC3, cv::Scalar::all(0));
  frame.shape.copyTo(shape(frame.crop));
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.TextureSubImage3D(shapes_.name(), 0, 0, 0, layer, side_px, side_px, 1, GL_RGB_INTEGER,
                        GL_UNSIGNED_BYTE, shape.data);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void FrameLayers::bind() const {
  gl_.BindTextureUnit(0, colours_.name());
  gl_.BindTextureUnit(1, shapes_.name());
}

}  // namespace sheen::render
