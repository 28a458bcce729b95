// SPDX-License-Identifier: MIT
#include "app/commands/smooth_picture.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace sheen::app {
namespace {

constexpr int kFiner = 2;  // drawn so much larger, so that outlines become smooth

/// A lens that sees all of the object whatever the picture's shape.
core::CameraModel whole_object_lens(const cv::Size& size_px) {
  const int side = std::min(size_px.width, size_px.height);
  core::CameraModel::Intrinsics intrinsics = OrbitCamera::lens(side, side).intrinsics();
  intrinsics.width_px = size_px.width;
  intrinsics.height_px = size_px.height;
  intrinsics.principal_px = {0.5 * (size_px.width - 1), 0.5 * (size_px.height - 1)};
  return core::CameraModel(intrinsics);
}

/// CV_8UC4, B G R A, not premultiplied.
cv::Mat with_alpha(const render::RenderedView& view, const cv::Size& size_px) {
  // Averages of the object's pixels alone: black beside it must not darken the outline.
  cv::Mat colours;
  cv::Mat covered;
  cv::resize(view.image, colours, size_px, 0, 0, cv::INTER_AREA);
  cv::resize(view.mask, covered, size_px, 0, 0, cv::INTER_AREA);
  cv::Mat picture(size_px, CV_8UC4, cv::Scalar::all(0));
  for (int y = 0; y < size_px.height; ++y) {
    for (int x = 0; x < size_px.width; ++x) {
      const int alpha = covered.at<std::uint8_t>(y, x);
      if (alpha == 0) continue;
      auto& pixel = picture.at<cv::Vec4b>(y, x);
      for (int channel = 0; channel < 3; ++channel) {
        const int value = colours.at<cv::Vec3b>(y, x)[channel] * 255 / alpha;
        pixel[channel] = static_cast<std::uint8_t>(std::min(value, 255));
      }
      pixel[3] = static_cast<std::uint8_t>(alpha);
    }
  }
  return picture;
}

}  // namespace

cv::Mat smooth_picture(render::Renderer& renderer, const OrbitCamera& camera,
                       const cv::Size& size_px) {
  const core::CameraModel lens = whole_object_lens(size_px * kFiner);
  return with_alpha(renderer.render(lens, camera.camera_from_object()), size_px);
}

}  // namespace sheen::app
