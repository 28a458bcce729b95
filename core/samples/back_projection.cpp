// SPDX-License-Identifier: MIT
#include "core/samples/back_projection.h"

#include "core/samples/sampling_kernels.h"

#include <cassert>
#include <vector>

namespace sheen::core {
namespace {

/// Whether all four pixels around the position exist.
bool has_neighbourhood(const cv::Mat& image, float x_px, float y_px) {
  return x_px >= 0.0f && y_px >= 0.0f && x_px < static_cast<float>(image.cols - 1) &&
         y_px < static_cast<float>(image.rows - 1);
}

/// Patches of the samples, ascending.
void choose_patches(const cv::Mat& image, const VertexView& view,
                    std::vector<std::uint32_t>& patches) {
  const std::size_t count = view.rejection.size();
  patches.resize(count);  // for all that may come; the storage stays when the batch shrinks
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < count; ++i) {
    patches[chosen] = static_cast<std::uint32_t>(i);
    chosen += view.rejection[i] == VertexRejection::none ? 1 : 0;
  }
  patches.resize(chosen);
  // The border margin promises four pixels; a view made for another image does not.
  std::erase_if(patches, [&](std::uint32_t i) {
    return !has_neighbourhood(image, view.x_px[i], view.y_px[i]);
  });
}

}  // namespace

void back_project(const cv::Mat& image, const VertexView& view, SampleBatch& batch) {
  assert(image.type() == CV_8UC3);
  choose_patches(image, view, batch.patch);
  for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) {
    column->resize(batch.patch.size());
  }
  sampling_kernel_sets().front().read(
      {image.data, image.step[0]},
      {view.x_px.data(), view.y_px.data(), view.u.data(), view.v.data(), batch.patch.data(),
       batch.u.data(), batch.v.data(), batch.r.data(), batch.g.data(), batch.b.data()},
      batch.patch.size());
}

}  // namespace sheen::core
