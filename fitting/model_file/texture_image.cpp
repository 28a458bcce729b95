// SPDX-License-Identifier: MIT
#include "fitting/model_file/texture_image.h"

#include "core/image/png.h"
#include "fitting/model_file/model_part.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace sheen::fitting {
namespace {

/// Red and blue change places: texels are RGB, images BGR.
void exchange_channels(const cv::Mat& from, cv::Mat& to) {
  cv::mixChannels(&from, 1, &to, 1, std::array<int, 6>{0, 2, 1, 1, 2, 0}.data(), 3);
}

cv::Mat view_of(std::vector<Texel>& texels, const cv::Size& size) {
  return {size, CV_8UC3, texels.data()};
}

}  // namespace

std::vector<std::uint8_t> encode_texture(const SurfaceTexture& texture) {
  std::vector<Texel> texels = texture.texels();
  const cv::Mat rgb = view_of(texels, {texture.atlas().width, texture.atlas().height});
  cv::Mat bgr(rgb.size(), CV_8UC3);
  exchange_channels(rgb, bgr);
  return core::encode_png(bgr);
}

SurfaceTexture decode_texture(std::span<const std::byte> bytes,
                              std::vector<std::array<core::AtlasPoint, 3>> corners) {
  const auto size = core::png_size(bytes);
  if (!size) throw ModelFault("its texture is no PNG of three channels");
  if (size->width > core::kMostAtlasSide || size->height > core::kMostAtlasSide ||
      size->area() > core::kMostAtlasTexels) {
    throw ModelFault("its texture is larger than sheen makes them");
  }
  const auto bgr = core::decode_png(bytes, *size);
  if (!bgr) throw ModelFault("its texture cannot be decoded");
  core::Atlas atlas;
  atlas.width = size->width;
  atlas.height = size->height;
  atlas.corners = std::move(corners);
  SurfaceTexture texture(std::move(atlas));
  cv::Mat rgb = view_of(texture.texels(), *size);
  exchange_channels(*bgr, rgb);
  return texture;
}

}  // namespace sheen::fitting
