// SPDX-License-Identifier: MIT
#include "core/image/png.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <span>

namespace sheen::core {
namespace {

cv::Mat random_image(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST(Png, GivesBackEveryBit) {
  for (const auto& size : {cv::Size(1, 1), cv::Size(7, 3), cv::Size(640, 2), cv::Size(100, 90)}) {
    const cv::Mat image = random_image(size.width, size.height);
    const auto bytes = encode_png(image);
    EXPECT_EQ(bytes, encode_png(image));
    EXPECT_EQ(png_size(std::as_bytes(std::span(bytes))), size);
    const auto back = decode_png(std::as_bytes(std::span(bytes)), size);
    ASSERT_TRUE(back);
    EXPECT_EQ(cv::norm(*back, image, cv::NORM_INF), 0);
  }
}

TEST(Png, RefusesOtherSizesAndOtherBytes) {
  const auto bytes = encode_png(random_image(20, 10));
  const auto all = std::as_bytes(std::span(bytes));
  EXPECT_FALSE(decode_png(all, {10, 20}));
  for (std::size_t length = 0; length + 12 < all.size(); length += 5) {
    if (const auto image = decode_png(all.first(length), {20, 10})) {
      EXPECT_EQ(image->size(), cv::Size(20, 10));  // the decoder may fill up what is missing
    }
  }
  EXPECT_FALSE(png_size({}));
  EXPECT_FALSE(png_size(all.subspan(1)));
}

}  // namespace
}  // namespace sheen::core
