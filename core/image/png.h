// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sheen::core {

/// An image (CV_8UC3 BGR, not empty) as the bytes of a PNG file, without loss. `effort` from 1 to
/// 9: as small as the encoder can, at several times the time of a middle one. Equal images give
/// equal bytes.
std::vector<std::uint8_t> encode_png(const cv::Mat& image, int effort = 9);

/// The image back, CV_8UC3 BGR. Nothing where the bytes are not a PNG of this size with three
/// channels of 8 bits: the size is looked at before anything is reserved for it.
std::optional<cv::Mat> decode_png(std::span<const std::byte> bytes, const cv::Size& size);

/// Width and height of a PNG of three channels of 8 bits, as its header says; nothing for others.
std::optional<cv::Size> png_size(std::span<const std::byte> bytes);

}  // namespace sheen::core
