// SPDX-License-Identifier: MIT
#include "capture/source/picture_check.h"

#include "core/diagnostics/error.h"

#include <string>

namespace sheen::capture {
namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

void check_picture_size(const std::filesystem::path& subject, const cv::Mat& image,
                        const PictureSize& expected) {
  if (image.cols == expected.width_px && image.rows == expected.height_px) return;
  throw core::bad_input(subject,
                        "is " + size_text(image.cols, image.rows) + " but the camera file says " +
                            size_text(expected.width_px, expected.height_px),
                        "use the camera file of this recording");
}

void check_range(const std::filesystem::path& subject, const FrameRange& range,
                 std::optional<int> frames) {
  if (range.start < 0 || (range.end && *range.end <= range.start)) {
    throw core::bad_input(subject, "no frame lies in the wanted range", "choose 0 <= start < end");
  }
  if (frames && range.start >= *frames) {
    throw core::bad_input(subject,
                          "has " + std::to_string(*frames) + " frames, none from frame " +
                              std::to_string(range.start),
                          "choose an earlier start");
  }
}

}  // namespace sheen::capture
