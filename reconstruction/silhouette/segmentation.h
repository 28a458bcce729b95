// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/silhouette/evidence.h"

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// Labels of a silhouette's pixels.
enum class PixelLabel : std::uint8_t { stage = 0, unknown = 1, object = 255 };

/// Cuts the object out of a view: minimal cut over 8 neighbours whose smoothness follows the
/// residual (study, step 3). `prior` (CV_32FC1, added to the log odds) may be empty. Pixels without
/// a known background that the cut does not give to the object are unknown. Returns CV_8UC1,
/// PixelLabel.
cv::Mat segment(const Evidence& evidence, const cv::Mat& prior, const cv::Rect& region);

}  // namespace sheen::reconstruction
