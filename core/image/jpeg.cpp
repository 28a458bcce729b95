// SPDX-License-Identifier: MIT
#include "core/image/jpeg.h"

#include "core/image/decode_colour.h"

#include <opencv2/imgcodecs.hpp>

#include <cassert>

namespace sheen::core {

std::vector<std::uint8_t> encode_jpeg(const cv::Mat& image, int quality) {
  assert(image.type() == CV_8UC3 && !image.empty());
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

// Segments: a marker FF xx, then their length, itself included. The frame header is the first of
// the markers C0 to CF that is neither a table (C4), nor reserved (C8), nor a condition (CC).
std::optional<cv::Size> jpeg_size(std::span<const std::byte> bytes) {
  const auto byte = [&](std::size_t at) { return std::to_integer<unsigned>(bytes[at]); };
  const auto word = [&](std::size_t at) { return byte(at) << 8U | byte(at + 1); };
  if (bytes.size() < 4 || word(0) != 0xffd8) return std::nullopt;
  std::size_t at = 2;
  while (at + 10 <= bytes.size()) {
    if (byte(at) != 0xff) return std::nullopt;
    const unsigned marker = byte(at + 1);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) {
      const bool usual = byte(at + 4) == 8 && byte(at + 9) == 3;
      const cv::Size size(static_cast<int>(word(at + 7)), static_cast<int>(word(at + 5)));
      return usual && !size.empty() ? std::optional(size) : std::nullopt;
    }
    at += 2 + word(at + 2);
  }
  return std::nullopt;
}

std::optional<cv::Mat> decode_jpeg(std::span<const std::byte> bytes, const cv::Size& size) {
  if (jpeg_size(bytes) != size) return std::nullopt;
  return decode_colour(bytes, size);
}

}  // namespace sheen::core
