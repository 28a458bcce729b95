// SPDX-License-Identifier: MIT
#include "capture/source/quarter_turn.h"

#include "capture/source/image_check.h"

namespace sheen::capture {

std::string describe(const Orientation& orientation) {
  std::string text = orientation.is_mirrored ? "mirrored" : "";
  if (orientation.clockwise_degrees != 0) {
    text += (text.empty() ? "turned by " : " and turned by ") +
            std::to_string(orientation.clockwise_degrees) + " degrees";
  }
  return text.empty() ? "upright" : text;
}

bool can_have_size(const ImageSize& stored, const ImageSize& expected,
                   const Orientation& orientation) {
  return stored == expected ||
         (orientation.swaps_sides() && ImageSize{stored.height_px, stored.width_px} == expected);
}

TurnChoice choose_turn(const std::filesystem::path& subject, const ImageSize& stored,
                       const ImageSize& expected, const Orientation& orientation) {
  if (!(stored == expected) && can_have_size(stored, expected, orientation)) {
    return {true, "is to be shown " + describe(orientation) +
                      ", and the camera file is for the turned images: they are turned"};
  }
  check_image_size(subject, stored, expected);
  if (orientation.is_upright()) return {};
  return {false, "is to be shown " + describe(orientation) +
                     "; the stored pixels are taken, as the camera file is for those"};
}

cv::Mat turned(const cv::Mat& image, const Orientation& orientation) {
  cv::Mat result = image;
  if (orientation.is_mirrored) cv::flip(image, result, 1);
  switch (orientation.clockwise_degrees) {
    case 90:
      cv::rotate(result, result, cv::ROTATE_90_CLOCKWISE);
      break;
    case 180:
      cv::rotate(result, result, cv::ROTATE_180);
      break;
    case 270:
      cv::rotate(result, result, cv::ROTATE_90_COUNTERCLOCKWISE);
      break;
    default:
      break;
  }
  return result;
}

}  // namespace sheen::capture
