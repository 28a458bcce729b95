// SPDX-License-Identifier: MIT
#include "fitting/texture/surface_texture.h"

#include <algorithm>
#include <utility>

namespace sheen::fitting {

SurfaceTexture::SurfaceTexture(core::Atlas atlas)
    : atlas_(std::move(atlas)),
      texels_(atlas_.texel_count(), Texel{128, 128, 128}),
      pages_per_row_(static_cast<std::size_t>((atlas_.width + kPage - 1) / kPage)) {}

std::size_t SurfaceTexture::page_count() const {
  return pages_per_row_ * static_cast<std::size_t>((atlas_.height + kPage - 1) / kPage);
}

cv::Rect SurfaceTexture::page(std::size_t page_idx) const {
  const int x = kPage * static_cast<int>(page_idx % pages_per_row_);
  const int y = kPage * static_cast<int>(page_idx / pages_per_row_);
  return {x, y, std::min(kPage, atlas_.width - x), std::min(kPage, atlas_.height - y)};
}

Eigen::Vector3f SurfaceTexture::read(const Eigen::Vector2f& place) const {
  // Centres of texels lie at halves.
  const float x = std::clamp(place.x() - 0.5f, 0.0f, static_cast<float>(atlas_.width - 1));
  const float y = std::clamp(place.y() - 0.5f, 0.0f, static_cast<float>(atlas_.height - 1));
  const auto left = static_cast<std::size_t>(x);
  const auto top = static_cast<std::size_t>(y);
  const auto width = static_cast<std::size_t>(atlas_.width);
  const std::size_t to_right = left + 1 < width ? 1 : 0;
  const std::size_t to_below = top + 1 < static_cast<std::size_t>(atlas_.height) ? width : 0;
  const float right = x - static_cast<float>(left);
  const float below = y - static_cast<float>(top);
  const auto colour = [&](std::size_t idx) {
    const Texel& texel = texels_[idx];
    return Eigen::Vector3f(texel[0], texel[1], texel[2]);
  };
  const std::size_t idx = top * width + left;
  const Eigen::Vector3f upper = (1.0f - right) * colour(idx) + right * colour(idx + to_right);
  const Eigen::Vector3f lower =
      (1.0f - right) * colour(idx + to_below) + right * colour(idx + to_below + to_right);
  return ((1.0f - below) * upper + below * lower) / 255.0f;
}

}  // namespace sheen::fitting
