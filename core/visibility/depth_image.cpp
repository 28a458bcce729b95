// SPDX-License-Identifier: MIT
#include "core/visibility/depth_image.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sheen::core {
namespace {

/// Box of all projected vertices within the image.
cv::Rect projected_box(const VertexView& view, const cv::Size& size) {
  float left = std::numeric_limits<float>::infinity();
  float top = left;
  float right = -left;
  float bottom = -left;
  for (std::size_t i = 0; i < view.x_px.size(); ++i) {
    if (!(view.depth_m[i] > 0.0f)) continue;
    left = std::min(left, view.x_px[i]);
    right = std::max(right, view.x_px[i]);
    top = std::min(top, view.y_px[i]);
    bottom = std::max(bottom, view.y_px[i]);
  }
  if (!(left <= right)) return {};
  const auto within = [](float x, int most) {
    return static_cast<int>(std::clamp(std::floor(x), 0.0f, static_cast<float>(most)));
  };
  const cv::Point first(within(left, size.width), within(top, size.height));
  const cv::Point last(within(right + 2.0f, size.width), within(bottom + 2.0f, size.height));
  return {first, last};
}

}  // namespace

DepthImage::DepthImage(const Mesh& mesh, int threads)
    : buffer_(mesh, threads, raster_kernel_sets().front()), threads_(threads) {}

void DepthImage::draw(const VertexView& view, const cv::Size& image_size,
                      const Eigen::Isometry3d& camera_from_object) {
  box_ = projected_box(view, image_size);
  depth_m_.create(box_.size(), CV_32FC1);
  if (box_.empty()) return;
  static_cast<void>(
      buffer_.draw(view, eye_in_object(camera_from_object),
                   {box_.x, box_.y, box_.x + box_.width - 1, box_.y + box_.height - 1}));
  parallel_for(
      static_cast<std::size_t>(box_.height), threads_,
      [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          auto* const row = depth_m_.ptr<float>(y);
          for (int x = 0; x < box_.width; ++x) {
            const float inverse = buffer_.at(box_.x + x, box_.y + y);
            row[x] = inverse > 0.0f ? 1.0f / inverse : 0.0f;
          }
        }
      },
      16);
}

}  // namespace sheen::core
