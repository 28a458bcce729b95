// SPDX-License-Identifier: MIT
#include "capture/source/image_check.h"

#include "core/diagnostics/error.h"

#include <string>

namespace sheen::capture {
namespace {

std::string text(const ImageSize& size) {
  return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

}  // namespace

void check_image_size(const std::filesystem::path& subject, const ImageSize& size,
                      const ImageSize& expected) {
  if (size == expected) return;
  throw core::bad_input(subject, "is " + text(size) + " but the camera file says " + text(expected),
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
