// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// What the refinement knows of every view besides its image.
struct ViewBackground {
  cv::Mat colour;  ///< CV_8UC3, BGR: the stage as the view would show it without the object
  cv::Mat known;   ///< CV_8UC1, not 0 where it was seen, not guessed
};

}  // namespace sheen::reconstruction
