// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/stage/background.h"

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// Distance of every pixel from a silhouette's outline, px, positive outside: CV_32FC1. `labels` is
/// CV_8UC1, PixelLabel; unknown pixels are deep inside, so that they carve nothing.
cv::Mat silhouette_distance(const cv::Mat& labels);

/// The same to a fraction of a pixel (study, step 5a): along every normal of the outline the share
/// of the object's colour, from `image` (CV_8UC3, BGR), the colours just within and the background,
/// says where its edge really is; the distances move by that.
cv::Mat matted_distance(const cv::Mat& labels, const cv::Mat& image, const Background& background);

}  // namespace sheen::reconstruction
