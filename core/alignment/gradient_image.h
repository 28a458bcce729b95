// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <optional>

namespace sheen::core {

/// Rec. 601 luma of display-referred sRGB, the brightness that alignment compares.
inline float luma(float r, float g, float b) {
  return 0.299f * r + 0.587f * g + 0.114f * b;
}

/// Part of an image as smoothed luma with its gradient. Reuses its storage from frame to frame.
class GradientImage {
 public:
  struct Reading {
    double value = 0;          ///< luma, [0, 1]
    Eigen::Vector2d gradient;  ///< per px
  };

  /// Takes `region` (clipped to the image) of a CV_8UC3 BGR image, smoothed by a Gaussian of
  /// `smoothing_px`.
  void look_at(const cv::Mat& image, const cv::Rect& region, double smoothing_px);

  /// The same region smoothed once more by `smoothing_px`.
  [[nodiscard]] GradientImage smoothed(double smoothing_px) const;

  /// Bilinear value and gradient at a pixel of the whole image; nothing outside the region.
  [[nodiscard]] std::optional<Reading> read(const Eigen::Vector2d& pixel) const;

 private:
  void differentiate();

  cv::Point corner_;  ///< upper left pixel of the region
  cv::Mat values_;    ///< CV_32FC1
  cv::Mat packed_;    ///< CV_32FC3: value, gradient x, gradient y: read together
};

}  // namespace sheen::core
