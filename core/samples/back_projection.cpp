// SPDX-License-Identifier: MIT
#include "core/samples/back_projection.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sheen::core {
namespace {

void resize(SampleBatch& batch, std::size_t count) {
  batch.patch.resize(count);
  for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) column->resize(count);
}

/// Whether all four pixels around the position exist.
bool has_neighbourhood(const cv::Mat& image, float x_px, float y_px) {
  return x_px >= 0.0f && y_px >= 0.0f && x_px < static_cast<float>(image.cols - 1) &&
         y_px < static_cast<float>(image.rows - 1);
}

/// Bilinear value of the three channels as stored, range [0, 255].
cv::Vec3f bilinear(const cv::Mat& image, float x_px, float y_px) {
  const int x = static_cast<int>(x_px);
  const int y = static_cast<int>(y_px);
  const float right = x_px - static_cast<float>(x);
  const float down = y_px - static_cast<float>(y);
  const cv::Vec3b* upper = image.ptr<cv::Vec3b>(y) + x;
  const cv::Vec3b* lower = image.ptr<cv::Vec3b>(y + 1) + x;
  cv::Vec3f value;
  for (int c = 0; c < 3; ++c) {
    const float top =
        static_cast<float>(upper[0][c]) * (1.0f - right) + static_cast<float>(upper[1][c]) * right;
    const float bottom =
        static_cast<float>(lower[0][c]) * (1.0f - right) + static_cast<float>(lower[1][c]) * right;
    value[c] = top * (1.0f - down) + bottom * down;
  }
  return value;
}

}  // namespace

void back_project(const cv::Mat& image, const VertexView& view, SampleBatch& batch) {
  assert(image.type() == CV_8UC3);
  constexpr float unit = 1.0f / 255.0f;
  // Size once for all that may come; the storage stays when the batch shrinks.
  resize(batch, static_cast<std::size_t>(std::count(view.rejection.begin(), view.rejection.end(),
                                                    VertexRejection::none)));
  std::size_t sample_idx = 0;
  for (std::size_t i = 0; i < view.rejection.size(); ++i) {
    if (view.rejection[i] != VertexRejection::none) continue;
    // The border margin promises four pixels; a view made for another picture does not.
    if (!has_neighbourhood(image, view.x_px[i], view.y_px[i])) continue;
    const cv::Vec3f bgr = bilinear(image, view.x_px[i], view.y_px[i]);
    batch.patch[sample_idx] = static_cast<std::uint32_t>(i);
    batch.u[sample_idx] = view.u[i];
    batch.v[sample_idx] = view.v[i];
    batch.r[sample_idx] = bgr[2] * unit;
    batch.g[sample_idx] = bgr[1] * unit;
    batch.b[sample_idx] = bgr[0] * unit;
    ++sample_idx;
  }
  resize(batch, sample_idx);
}

}  // namespace sheen::core
