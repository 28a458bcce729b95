// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/matx.hpp>

namespace sheen::reconstruction {

/// Brightness of a colour, BGR.
inline float luma_of(const cv::Vec3f& bgr) {
  return 0.114F * bgr[0] + 0.587F * bgr[1] + 0.299F * bgr[2];
}

}  // namespace sheen::reconstruction
