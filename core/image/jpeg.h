// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sheen::core {

/// An image (CV_8UC3 BGR, not empty, at most 65500 pixels a side) as the bytes of a JPEG file;
/// `quality` in [1, 100]. Equal images give equal bytes.
std::vector<std::uint8_t> encode_jpeg(const cv::Mat& image, int quality);

/// The image back, CV_8UC3 BGR. Nothing where the bytes are not a JPEG of this size: the size is
/// looked at before anything is reserved for it.
std::optional<cv::Mat> decode_jpeg(std::span<const std::byte> bytes, const cv::Size& size);

/// Width and height of a JPEG of 8 bits and three channels, as its frame header says; nothing for
/// others.
std::optional<cv::Size> jpeg_size(std::span<const std::byte> bytes);

}  // namespace sheen::core
