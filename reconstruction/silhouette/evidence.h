// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/stage/background.h"

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// What speaks for the object at every pixel of a view.
struct Evidence {
  cv::Mat log_odds;  ///< CV_32FC1, object against stage; 0 where nothing is known
  cv::Mat residual;  ///< CV_32FC3, image less background; the print's edges vanish from it
  cv::Mat known;     ///< CV_8UC1, not 0 where the background is known or guessed
};

/// Compares an image (CV_8UC3, BGR) with its background (study, step 2).
Evidence compare_with_background(const cv::Mat& image, const Background& background);

}  // namespace sheen::reconstruction
