// SPDX-License-Identifier: MIT
#include "core/image/jpeg.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <span>

namespace sheen::core {
namespace {

/// A smooth grey slope, 37 x 21: only the rounding of its coefficients is lost.
std::vector<std::uint8_t> slope_jpeg(cv::Mat& image) {
  image.create(21, 37, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(static_cast<std::uint8_t>(40 + 3 * x + 2 * y));
    }
  }
  return encode_jpeg(image, 100);
}

TEST(Jpeg, ComesBackAlmostAsItWas) {
  cv::Mat image;
  const auto file = slope_jpeg(image);
  const auto bytes = std::as_bytes(std::span(file));
  EXPECT_EQ(jpeg_size(bytes), cv::Size(37, 21));
  const auto back = decode_jpeg(bytes, {37, 21});
  ASSERT_TRUE(back);
  EXPECT_LE(cv::norm(*back, image, cv::NORM_INF), 2);
  EXPECT_EQ(file, encode_jpeg(image, 100));
}

// Cut short anywhere before the end of its headers it has no size; nothing reads beyond its end.
TEST(Jpeg, RefusesWhatIsNone) {
  cv::Mat image;
  const auto file = slope_jpeg(image);
  const auto bytes = std::as_bytes(std::span(file));
  EXPECT_FALSE(decode_jpeg(bytes, {21, 37}));
  EXPECT_FALSE(jpeg_size({}));
  for (std::size_t length = 0; length < 64; ++length) {
    EXPECT_FALSE(jpeg_size(bytes.first(length))) << length;
    EXPECT_FALSE(decode_jpeg(bytes.first(length), {37, 21})) << length;
  }
  EXPECT_FALSE(jpeg_size(bytes.subspan(1)));
}

}  // namespace
}  // namespace sheen::core
