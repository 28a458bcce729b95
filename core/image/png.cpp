// SPDX-License-Identifier: MIT
#include "core/image/png.h"

#include "core/image/decode_colour.h"

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace sheen::core {
namespace {

/// What every such file begins with: signature, then length and type of the header chunk.
constexpr std::array<std::uint8_t, 16> kBegin{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                              0,    0,   0,   13,  'I',  'H',  'D',  'R'};
constexpr std::size_t kHeaderEnd = 29;

std::uint32_t big_endian(std::span<const std::byte, 4> bytes) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes) value = value << 8U | std::to_integer<std::uint32_t>(byte);
  return value;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const cv::Mat& image, int effort) {
  assert(image.type() == CV_8UC3 && !image.empty());
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, effort});
  return bytes;
}

std::optional<cv::Size> png_size(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderEnd) return std::nullopt;
  if (!std::ranges::equal(kBegin, bytes.first(kBegin.size()), {}, {},
                          std::to_integer<std::uint8_t>)) {
    return std::nullopt;
  }
  const std::uint32_t width = big_endian(bytes.subspan<16, 4>());
  const std::uint32_t height = big_endian(bytes.subspan<20, 4>());
  constexpr auto most = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
  const bool eight_bits = std::to_integer<int>(bytes[24]) == 8;
  const bool three_channels = std::to_integer<int>(bytes[25]) == 2;
  if (width == 0 || height == 0 || width > most || height > most || !eight_bits ||
      !three_channels) {
    return std::nullopt;
  }
  return cv::Size(static_cast<int>(width), static_cast<int>(height));
}

std::optional<cv::Mat> decode_png(std::span<const std::byte> bytes, const cv::Size& size) {
  if (png_size(bytes) != size) return std::nullopt;
  return decode_colour(bytes, size);
}

}  // namespace sheen::core
