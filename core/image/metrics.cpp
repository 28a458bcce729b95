// SPDX-License-Identifier: MIT
#include "core/image/metrics.h"

#include <opencv2/imgproc.hpp>

#include <cassert>
#include <cmath>

namespace sheen::core {
namespace {

constexpr double kEqualPsnr = 99.0;
constexpr int kWindow = 11;
constexpr double kWindowSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;  // (K1 L)^2 with L = 1
constexpr double kC2 = 0.03 * 0.03;

cv::Mat unit_range(const cv::Mat& image) {
  cv::Mat scaled;
  image.convertTo(scaled, CV_64F, 1.0 / 255.0);
  return scaled;
}

cv::Mat window_sum(const cv::Mat& values) {
  cv::Mat sum;
  cv::GaussianBlur(values, sum, {kWindow, kWindow}, kWindowSigma, kWindowSigma,
                   cv::BORDER_CONSTANT | cv::BORDER_ISOLATED);
  return sum;
}

/// SSIM of every pixel of one channel. Windows count pixels of the mask only: what lies behind the
/// object is not compared. `inside` is 1 on the mask and 0 elsewhere, `weight` its window sum.
cv::Mat ssim_map(const cv::Mat& x, const cv::Mat& y, const cv::Mat& inside, const cv::Mat& weight) {
  const auto window_mean = [&](const cv::Mat& values) {
    return cv::Mat(window_sum(values.mul(inside)) / weight);
  };
  const cv::Mat mean_x = window_mean(x);
  const cv::Mat mean_y = window_mean(y);
  const cv::Mat variance_x = window_mean(x.mul(x)) - mean_x.mul(mean_x);
  const cv::Mat variance_y = window_mean(y.mul(y)) - mean_y.mul(mean_y);
  const cv::Mat covariance = window_mean(x.mul(y)) - mean_x.mul(mean_y);
  const cv::Mat numerator = (2 * mean_x.mul(mean_y) + kC1).mul(2 * covariance + kC2);
  const cv::Mat denominator =
      (mean_x.mul(mean_x) + mean_y.mul(mean_y) + kC1).mul(variance_x + variance_y + kC2);
  return numerator / denominator;
}

double mean_ssim(const cv::Mat& x, const cv::Mat& y, const cv::Mat& mask) {
  cv::Mat inside;
  cv::Mat(mask != 0).convertTo(inside, CV_64F, 1.0 / 255.0);
  const cv::Mat weight = window_sum(inside);
  cv::Mat x_channels[3];
  cv::Mat y_channels[3];
  cv::split(x, x_channels);
  cv::split(y, y_channels);
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    sum += cv::mean(ssim_map(x_channels[c], y_channels[c], inside, weight), mask)[0];
  }
  return sum / 3;
}

double mean_squared_error(const cv::Mat& x, const cv::Mat& y, const cv::Mat& mask) {
  const cv::Mat difference = x - y;
  const cv::Scalar mean = cv::mean(difference.mul(difference), mask);
  return (mean[0] + mean[1] + mean[2]) / 3;
}

}  // namespace

std::optional<ImageError> image_error(const cv::Mat& image, const cv::Mat& reference,
                                      const cv::Mat& mask) {
  assert(image.type() == CV_8UC3 && reference.type() == CV_8UC3 && mask.type() == CV_8UC1);
  assert(image.size() == reference.size() && image.size() == mask.size());
  const int pixels = cv::countNonZero(mask);
  if (pixels == 0) return std::nullopt;
  // Only the box around the mask takes part.
  const cv::Rect box = cv::boundingRect(mask);
  const cv::Mat x = unit_range(image(box));
  const cv::Mat y = unit_range(reference(box));
  const double mse = mean_squared_error(x, y, mask(box));

  ImageError error;
  error.psnr_db = mse > 0 ? -10 * std::log10(mse) : kEqualPsnr;
  error.ssim = mean_ssim(x, y, mask(box));
  error.rmse = std::sqrt(mse);
  error.pixels = static_cast<std::size_t>(pixels);
  return error;
}

cv::Mat eroded(const cv::Mat& mask, int pixels) {
  assert(mask.type() == CV_8UC1 && pixels >= 0);
  const int side = 2 * pixels + 1;
  cv::Mat shrunk;
  cv::erode(mask, shrunk, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {-1, -1}, 1,
            cv::BORDER_CONSTANT | cv::BORDER_ISOLATED, cv::Scalar(0));
  return shrunk;
}

}  // namespace sheen::core
