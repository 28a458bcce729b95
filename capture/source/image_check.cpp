// SPDX-License-Identifier: MIT
#include "capture/source/image_check.h"

#include "core/diagnostics/error.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace sheen::capture {
namespace {

/// Images of one lens that were made smaller or larger keep their shape; others were cropped, too.
std::string remedy_for(const ImageSize& size, const ImageSize& expected) {
  if (size.width_px == expected.height_px && size.height_px == expected.width_px) {
    return "the images are turned by 90 degrees against it: calibrate from such images, or turn "
           "them back";
  }
  const auto across = std::int64_t{size.width_px} * expected.height_px;
  const auto down = std::int64_t{size.height_px} * expected.width_px;
  if (across != down || expected.width_px <= 0) {
    return "use the camera file of this recording; the shape differs, so scaling does not do";
  }
  return fmt::format(
      "use the camera file of this recording, or if it was scaled, multiply fx, fy, cx + 0.5 and "
      "cy + 0.5 in that file by {:.6g}",
      static_cast<double>(size.width_px) / expected.width_px);
}

}  // namespace

std::string size_text(const ImageSize& size) {
  return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

void check_image_size(const std::filesystem::path& subject, const ImageSize& size,
                      const ImageSize& expected) {
  if (size == expected) return;
  throw core::bad_input(
      subject, "is " + size_text(size) + " but the camera file says " + size_text(expected),
      remedy_for(size, expected));
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
