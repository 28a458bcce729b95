// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace sheen::capture {

/// Size that the header of a JPEG image states; nothing when there is no such header.
std::optional<ImageSize> jpeg_size(std::span<const std::uint8_t> jpeg);

/// Decodes a baseline or progressive JPEG image into `bgr` (CV_8UC3), whose memory is used again
/// where its size fits. The image stands alone: Huffman tables that it leaves out, as cameras do,
/// are the standard's. False, with `bgr` in any state, when the bytes are no image of the given
/// size or end early.
[[nodiscard]] bool decode_jpeg(std::span<const std::uint8_t> jpeg, const ImageSize& size,
                               cv::Mat& bgr);

}  // namespace sheen::capture
