// SPDX-License-Identifier: MIT
#include "core/image/decode_colour.h"

#include <opencv2/imgcodecs.hpp>

#include <limits>

namespace sheen::core {

std::optional<cv::Mat> decode_colour(std::span<const std::byte> bytes, const cv::Size& size) {
  if (bytes.size() > std::numeric_limits<int>::max()) return std::nullopt;
  // The decoder wants bytes that it could change, and leaves them alone.
  const cv::Mat file(1, static_cast<int>(bytes.size()), CV_8UC1,
                     const_cast<std::byte*>(bytes.data()));
  try {
    cv::Mat image = cv::imdecode(file, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    if (image.size() != size || image.type() != CV_8UC3) return std::nullopt;
    return image;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
}

}  // namespace sheen::core
