// SPDX-License-Identifier: MIT
#include "capture/board_print/tag_bitmap.h"

#include <cassert>
#include <cstdlib>
#include <memory>

namespace sheen::capture {
namespace {

// What image_u8_destroy does; Debian's libapriltag does not export it.
struct ImageDeleter {
  void operator()(image_u8_t* image) const {
    std::free(image->buf);
    std::free(image);
  }
};

}  // namespace

TagBitmap draw_tag(const AprilTagFamily& family, int id) {
  assert(id >= 0 && static_cast<unsigned>(id) < family.get()->ncodes);
  const std::unique_ptr<image_u8_t, ImageDeleter> image(
      apriltag_to_image(family.get(), static_cast<unsigned>(id)));
  assert(image->width == image->height);
  TagBitmap bitmap{image->width, family.get()->width_at_border, {}};
  for (int row = 0; row < image->height; ++row) {
    for (int column = 0; column < image->width; ++column) {
      bitmap.black.push_back(image->buf[row * image->stride + column] < 128);
    }
  }
  return bitmap;
}

}  // namespace sheen::capture
