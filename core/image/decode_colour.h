// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <optional>
#include <span>

namespace sheen::core {

/// The image of an encoded file, CV_8UC3 BGR, as it is stored (orientation tags are ignored);
/// nothing when it cannot be decoded or is not of this size.
std::optional<cv::Mat> decode_colour(std::span<const std::byte> bytes, const cv::Size& size);

}  // namespace sheen::core
