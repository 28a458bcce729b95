// SPDX-License-Identifier: MIT
#include "core/alignment/gradient_image.h"

#include <opencv2/imgproc.hpp>

#include <cassert>

namespace sheen::core {

void GradientImage::look_at(const cv::Mat& image, const cv::Rect& region, double smoothing_px) {
  assert(image.type() == CV_8UC3);
  assert(smoothing_px > 0);
  const cv::Rect clipped = region & cv::Rect(0, 0, image.cols, image.rows);
  corner_ = clipped.tl();
  if (clipped.empty()) {
    packed_.release();
    return;
  }
  // In floats from the start: luma rounded to 8 bits would lose the weak gradients.
  cv::Mat colours;
  image(clipped).convertTo(colours, CV_32F, 1.0 / 255);
  cv::cvtColor(colours, values_, cv::COLOR_BGR2GRAY);
  cv::GaussianBlur(values_, values_, {}, smoothing_px);
  differentiate();
}

GradientImage GradientImage::smoothed(double smoothing_px) const {
  GradientImage result;
  result.corner_ = corner_;
  if (packed_.empty()) return result;
  cv::GaussianBlur(values_, result.values_, {}, smoothing_px);
  result.differentiate();
  return result;
}

std::optional<GradientImage::Reading> GradientImage::read(const Eigen::Vector2d& pixel) const {
  const double x = pixel.x() - corner_.x;
  const double y = pixel.y() - corner_.y;
  if (!(x >= 0 && y >= 0 && x < packed_.cols - 1 && y < packed_.rows - 1)) return std::nullopt;
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const auto right = static_cast<float>(x - column);
  const auto down = static_cast<float>(y - row);
  const cv::Vec3f* upper = packed_.ptr<cv::Vec3f>(row) + column;
  const cv::Vec3f* lower = packed_.ptr<cv::Vec3f>(row + 1) + column;
  const cv::Vec3f mixed = (upper[0] * (1 - right) + upper[1] * right) * (1 - down) +
                          (lower[0] * (1 - right) + lower[1] * right) * down;
  return Reading{static_cast<double>(mixed[0]),
                 {static_cast<double>(mixed[1]), static_cast<double>(mixed[2])}};
}

void GradientImage::differentiate() {
  cv::Mat planes[3] = {values_, {}, {}};
  cv::Sobel(values_, planes[1], CV_32F, 1, 0, 1, 0.5);  // size 1: central difference
  cv::Sobel(values_, planes[2], CV_32F, 0, 1, 1, 0.5);
  cv::merge(planes, 3, packed_);
}

}  // namespace sheen::core
