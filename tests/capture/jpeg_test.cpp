// SPDX-License-Identifier: MIT
#include "capture/source/jpeg_decoder.h"
#include "capture/source/jpeg_encoder.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <random>
#include <vector>

namespace sheen::capture::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr ImageSize kSize{96, 64};

/// A smooth coloured image: what a lens delivers.
cv::Mat smooth_image() {
  cv::Mat light(kSize.height_px, kSize.width_px, CV_32FC3);
  cv::RNG random(7);
  random.fill(light, cv::RNG::UNIFORM, 0, 1);
  cv::GaussianBlur(light, light, {}, 16);
  cv::normalize(light, light, 40, 215, cv::NORM_MINMAX);
  cv::Mat image;
  light.convertTo(image, CV_8UC3);
  return image;
}

Bytes jpeg_of(const cv::Mat& image) {
  Bytes jpeg;
  cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, 92});
  return jpeg;
}

/// Takes the segments of a marker out of a JPEG's header.
Bytes without_segments(const Bytes& jpeg, std::uint8_t marker) {
  Bytes result(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  while (jpeg.at(at + 1) != 0xda) {  // start of scan
    const std::size_t length = 2U + jpeg.at(at + 2) * 256U + jpeg.at(at + 3);
    if (jpeg[at + 1] != marker) {
      result.insert(result.end(), jpeg.begin() + static_cast<long>(at),
                    jpeg.begin() + static_cast<long>(at + length));
    }
    at += length;
  }
  result.insert(result.end(), jpeg.begin() + static_cast<long>(at), jpeg.end());
  return result;
}

TEST(JpegDecoder, AgreesWithOpenCv) {
  const Bytes jpeg = jpeg_of(smooth_image());
  cv::Mat ours;
  ASSERT_TRUE(decode_jpeg(jpeg, kSize, ours));
  // Both are libjpeg's decoder with its interpolated chroma: the same pixels, up to one rounding of
  // two versions of the inverse transform.
  EXPECT_LE(cv::norm(ours, cv::imdecode(jpeg, cv::IMREAD_COLOR), cv::NORM_INF), 1);
}

TEST(JpegDecoder, TakesTheStandardTablesWhereACameraLeavesThemOut) {
  // OpenCV writes the standard's Huffman tables, so that leaving them out changes nothing.
  const Bytes whole = jpeg_of(smooth_image());
  const Bytes bare = without_segments(whole, 0xc4);
  ASSERT_LT(bare.size() + 400, whole.size());  // the four tables take 420 bytes
  cv::Mat expected, decoded;
  ASSERT_TRUE(decode_jpeg(whole, kSize, expected));
  ASSERT_TRUE(decode_jpeg(bare, kSize, decoded));
  EXPECT_EQ(cv::norm(expected, decoded, cv::NORM_INF), 0);
}

TEST(JpegDecoder, LetsNoImageChangeTheNext) {
  // Tables of an image with its own must not be used for one without any.
  Bytes optimised;
  cv::imencode(".jpg", smooth_image(), optimised, {cv::IMWRITE_JPEG_OPTIMIZE, 1});
  const Bytes bare = without_segments(jpeg_of(smooth_image()), 0xc4);
  cv::Mat alone, after;
  ASSERT_TRUE(decode_jpeg(bare, kSize, alone));
  ASSERT_TRUE(decode_jpeg(optimised, kSize, after));
  ASSERT_TRUE(decode_jpeg(bare, kSize, after));
  EXPECT_EQ(cv::norm(alone, after, cv::NORM_INF), 0);
}

TEST(JpegDecoder, UsesItsMemoryAgain) {
  const Bytes jpeg = jpeg_of(smooth_image());
  cv::Mat image;
  ASSERT_TRUE(decode_jpeg(jpeg, kSize, image));
  const auto* const memory = image.data;
  ASSERT_TRUE(decode_jpeg(jpeg, kSize, image));
  EXPECT_EQ(image.data, memory);
}

TEST(JpegDecoder, TakesPaddingButNoDamage) {
  const Bytes jpeg = jpeg_of(smooth_image());
  cv::Mat image;
  Bytes padded = jpeg;
  padded.resize(jpeg.size() + 512, 0);
  EXPECT_TRUE(decode_jpeg(padded, kSize, image));

  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{20}, jpeg.size() / 4,
                                   jpeg.size() / 2, jpeg.size() - 20}) {
    EXPECT_FALSE(decode_jpeg(std::span(jpeg).first(length), kSize, image)) << length;
  }
  EXPECT_FALSE(decode_jpeg(jpeg, {kSize.width_px, kSize.height_px + 1}, image));
  EXPECT_FALSE(decode_jpeg(Bytes(5000, 0), kSize, image));
  EXPECT_EQ(jpeg_size(jpeg), kSize);
  EXPECT_FALSE(jpeg_size(Bytes(5000, 0)));
}

TEST(JpegDecoder, SurvivesAnyBytes) {
  const Bytes jpeg = jpeg_of(smooth_image());
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    Bytes spoilt = jpeg;
    for (int k = 0; k < 4; ++k)
      spoilt[random() % spoilt.size()] = static_cast<std::uint8_t>(random());
    cv::Mat image;
    if (!decode_jpeg(spoilt, kSize, image)) {
      ++refused;
    } else {
      EXPECT_EQ(image.size(), cv::Size(kSize.width_px, kSize.height_px));
    }
  }
  EXPECT_GT(refused, 0);
}

/// `image` as a camera would deliver it: BT.601 in limited range.
struct RawImage {
  Bytes bytes;
  CameraBuffer buffer;
};

RawImage raw_of(const cv::Mat& bgr, PixelFormat format, int bytes_per_line) {
  // Y = 16 + 219 luma, Cb and Cr = 128 + 224 times the colour difference in [-0.5, 0.5].
  cv::Mat full;
  cv::cvtColor(bgr, full, cv::COLOR_BGR2YCrCb);
  const auto luma = [&](int y, int x) {
    return cv::saturate_cast<std::uint8_t>(16 + full.at<cv::Vec3b>(y, x)[0] * 219 / 255.0);
  };
  const auto chroma = [&](int y, int x, int channel, int rows) {
    double sum = 0;
    for (int dy = 0; dy < rows; ++dy) {
      for (int dx = 0; dx < 2; ++dx) sum += full.at<cv::Vec3b>(y + dy, x + dx)[channel] - 128.0;
    }
    return cv::saturate_cast<std::uint8_t>(128 + sum / (2 * rows) * 224 / 255);
  };
  RawImage raw;
  const auto line = static_cast<std::size_t>(bytes_per_line);
  const bool is_yuyv = format == PixelFormat::yuyv;
  raw.bytes.resize(line * static_cast<std::size_t>(is_yuyv ? bgr.rows : bgr.rows * 3 / 2));
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      const auto row = line * static_cast<std::size_t>(y);
      raw.bytes[row + static_cast<std::size_t>(is_yuyv ? 2 * x : x)] = luma(y, x);
      if (x % 2 != 0 || (!is_yuyv && y % 2 != 0)) continue;
      const std::size_t u =
          is_yuyv ? row + static_cast<std::size_t>(2 * x + 1)
                  : line * static_cast<std::size_t>(bgr.rows + y / 2) + static_cast<std::size_t>(x);
      raw.bytes[u] = chroma(y, x, 2, is_yuyv ? 1 : 2);
      raw.bytes[u + (is_yuyv ? 2 : 1)] = chroma(y, x, 1, is_yuyv ? 1 : 2);
    }
  }
  raw.buffer = {format, raw.bytes, bgr.cols, bgr.rows, bytes_per_line, 0, 0};
  return raw;
}

class JpegEncoderOf : public testing::TestWithParam<PixelFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, JpegEncoderOf,
                         testing::Values(PixelFormat::yuyv, PixelFormat::nv12));

TEST_P(JpegEncoderOf, KeepsTheColours) {
  // Errors RMS in levels: limited range and its way back in luma and chroma, 0.33 and 0.29 each;
  // quality 95 about 0.5. Blue and red add chroma times 1.8 and 1.4 to luma: about 1.3 levels, 46
  // dB. Limited range taken for full would cost up to 16 levels, 24 dB.
  const cv::Mat image = smooth_image();
  const int tight = GetParam() == PixelFormat::yuyv ? 2 * image.cols : image.cols;
  JpegEncoder encoder;
  for (const int padding : {0, 32}) {
    const RawImage raw = raw_of(image, GetParam(), tight + padding);
    const Bytes jpeg = encoder.encode(raw.buffer);
    cv::Mat decoded;
    ASSERT_TRUE(decode_jpeg(jpeg, kSize, decoded));
    EXPECT_GT(cv::PSNR(image, decoded), 42) << padding;
  }
}

TEST_P(JpegEncoderOf, RefusesTooFewBytes) {
  const cv::Mat image = smooth_image();
  RawImage raw =
      raw_of(image, GetParam(), GetParam() == PixelFormat::yuyv ? 2 * image.cols : image.cols);
  JpegEncoder encoder;
  EXPECT_FALSE(encoder.encode(raw.buffer).empty());
  raw.buffer.bytes = raw.buffer.bytes.first(raw.bytes.size() - 1);
  EXPECT_TRUE(encoder.encode(raw.buffer).empty());
  raw.buffer.bytes = raw.bytes;
  raw.buffer.width_px = 0;
  EXPECT_TRUE(encoder.encode(raw.buffer).empty());
  raw.buffer.width_px = kSize.width_px;
  raw.buffer.format = PixelFormat::mjpeg;
  EXPECT_TRUE(encoder.encode(raw.buffer).empty());
}

}  // namespace
}  // namespace sheen::capture::test
