// SPDX-License-Identifier: MIT
#include "core/image/metrics.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>

namespace sheen::core {
namespace {

cv::Mat noise(int seed, int rows = 26, int cols = 31) {
  cv::Mat image(rows, cols, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

cv::Mat full_mask(const cv::Mat& image) {
  return {image.size(), CV_8UC1, cv::Scalar(255)};
}

/// Sums of Gaussian weights over the pixels of the mask in one window.
struct Window {
  double weight = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
};

Window window_at(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& mask, int row,
                 int col, int channel) {
  Window sums;
  for (int dy = -5; dy <= 5; ++dy) {
    for (int dx = -5; dx <= 5; ++dx) {
      const cv::Point at(col + dx, row + dy);
      if (!cv::Rect(0, 0, mask.cols, mask.rows).contains(at) || mask.at<std::uint8_t>(at) == 0) {
        continue;
      }
      const double w = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
      const double x = image.at<cv::Vec3b>(at)[channel] / 255.0;
      const double y = reference.at<cv::Vec3b>(at)[channel] / 255.0;
      sums.weight += w;
      sums.x += w * x;
      sums.y += w * y;
      sums.xx += w * x * x;
      sums.yy += w * y * y;
      sums.xy += w * x * y;
    }
  }
  return sums;
}

/// Wang et al. 2004, pixel by pixel.
double naive_ssim(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& mask) {
  double sum = 0;
  int count = 0;
  for (int row = 0; row < mask.rows; ++row) {
    for (int col = 0; col < mask.cols; ++col) {
      if (mask.at<std::uint8_t>(row, col) == 0) continue;
      for (int channel = 0; channel < 3; ++channel, ++count) {
        const Window s = window_at(image, reference, mask, row, col, channel);
        const double mx = s.x / s.weight;
        const double my = s.y / s.weight;
        const double vx = s.xx / s.weight - mx * mx;
        const double vy = s.yy / s.weight - my * my;
        const double c = s.xy / s.weight - mx * my;
        sum +=
            (2 * mx * my + 1e-4) * (2 * c + 9e-4) / ((mx * mx + my * my + 1e-4) * (vx + vy + 9e-4));
      }
    }
  }
  return sum / count;
}

TEST(ImageError, OfEqualImagesIsNone) {
  const cv::Mat image = noise(1);
  const auto error = image_error(image, image, full_mask(image));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->psnr_db, 99);
  EXPECT_EQ(error->rmse, 0);
  EXPECT_NEAR(error->ssim, 1, 1e-12);
  EXPECT_EQ(error->pixels, 26u * 31u);
}

TEST(ImageError, OfAConstantOffsetHasAClosedForm) {
  const cv::Mat reference(20, 30, CV_8UC3, cv::Scalar(100, 120, 140));
  const cv::Mat image = reference + cv::Scalar(10, 10, 10);
  const auto error = image_error(image, reference, full_mask(image));
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->rmse, 10 / 255.0, 1e-12);
  EXPECT_NEAR(error->psnr_db, 20 * std::log10(25.5), 1e-9);
  // Without variance SSIM is (2 x y + C1) / (x^2 + y^2 + C1), here averaged over three values.
  double expected = 0;
  for (const double y : {100 / 255.0, 120 / 255.0, 140 / 255.0}) {
    const double x = y + 10 / 255.0;
    expected += (2 * x * y + 1e-4) / (x * x + y * y + 1e-4) / 3;
  }
  EXPECT_NEAR(error->ssim, expected, 1e-9);
}

TEST(ImageError, SsimAgreesWithThePaperPixelByPixel) {
  const cv::Mat reference = noise(2);
  cv::Mat image;
  cv::GaussianBlur(reference, image, {5, 5}, 1.0);
  cv::Mat mask(reference.size(), CV_8UC1, cv::Scalar(0));
  cv::circle(mask, {14, 12}, 9, cv::Scalar(255), cv::FILLED);
  mask.at<std::uint8_t>(25, 30) = 1;
  for (const cv::Mat& area : {mask, full_mask(reference)}) {
    const auto error = image_error(image, reference, area);
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->ssim, naive_ssim(image, reference, area), 1e-9);
  }
}

TEST(ImageError, WhatLiesOutsideTheMaskDoesNotCount) {
  const cv::Mat reference = noise(3);
  cv::Mat image = reference / 2;
  cv::Mat mask(reference.size(), CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(6, 5, 12, 10)) = 255;
  const auto error = image_error(image, reference, mask);
  cv::Mat other = noise(4);
  image.copyTo(other, mask);
  const auto other_error = image_error(other, reference, mask);
  ASSERT_TRUE(error && other_error);
  EXPECT_EQ(error->pixels, 120u);
  EXPECT_DOUBLE_EQ(error->psnr_db, other_error->psnr_db);
  EXPECT_NEAR(error->ssim, other_error->ssim, 1e-12);
}

TEST(ImageError, OfAnEmptyMaskDoesNotExist) {
  const cv::Mat image = noise(5);
  EXPECT_FALSE(image_error(image, image, cv::Mat::zeros(image.size(), CV_8UC1)));
}

TEST(Eroded, ShrinksFromSilhouetteAndBorder) {
  const cv::Mat mask(10, 12, CV_8UC1, cv::Scalar(255));
  const cv::Mat shrunk = eroded(mask, 2);
  EXPECT_EQ(cv::countNonZero(shrunk), 6 * 8);
  EXPECT_EQ(cv::boundingRect(shrunk), cv::Rect(2, 2, 8, 6));
  cv::Mat hole = mask.clone();
  hole.at<std::uint8_t>(5, 6) = 0;
  // A missing pixel takes the 5 x 5 around it, all of it within the 8 x 6 that are left.
  EXPECT_EQ(cv::countNonZero(eroded(hole, 2)), 6 * 8 - 25);
  EXPECT_EQ(cv::countNonZero(eroded(mask, 0) != mask), 0);
}

}  // namespace
}  // namespace sheen::core
