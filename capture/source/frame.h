// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

namespace sheen::capture {

/// One image as it left the camera.
struct Frame {
  cv::Mat image;         ///< CV_8UC3, BGR, distorted as the lens made it
  double time_s = 0;     ///< since the first frame
  int index = 0;         ///< position in the recording, counted from 0
  cv::Mat grey{};        ///< CV_8UC1, luma where the source gives it for free; empty otherwise
  double spacing_s = 0;  ///< usual time from frame to frame about here; 0 where nobody knows
};

}  // namespace sheen::capture
