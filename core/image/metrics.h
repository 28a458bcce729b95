// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <optional>

namespace sheen::core {

/// Difference of two images over a mask (docs/conventions.md, "image error").
struct ImageError {
  double psnr_db = 0;  ///< -10 log10(mean squared error over pixels and channels); 99 when equal
  double ssim = 0;     ///< mean over the mask, 11x11 Gaussian, sigma 1.5, mean of the channels
  double rmse = 0;     ///< of values scaled to [0, 1]
  std::size_t pixels = 0;
};

/// `image` and `reference` are CV_8UC3 of one size, `mask` CV_8UC1 (0 = ignore).
/// Nothing when the mask is empty.
std::optional<ImageError> image_error(const cv::Mat& image, const cv::Mat& reference,
                                      const cv::Mat& mask);

/// Mask shrunk by `pixels` against silhouette and pose error; the image's border shrinks it too.
cv::Mat eroded(const cv::Mat& mask, int pixels);

}  // namespace sheen::core
