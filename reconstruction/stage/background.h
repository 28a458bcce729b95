// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/stage/stage_map.h"

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// What a view would show without the object.
struct Background {
  cv::Mat colour;  ///< CV_32FC3, BGR, [0, 1], with the view's exposure, vignetting and sheen
  cv::Mat sigma;   ///< CV_32FC1, standard deviation expected of a pixel's channel
  cv::Mat source;  ///< CV_8UC1, TexelSource; unknown outside the map
};

/// The map seen by a view. Gain and offset per window of a tenth of the width are fitted robustly
/// to the image where `mask` (CV_8UC1, not 0: object; may be empty) shows the stage, with a pull
/// towards `gain` that is `trust` times that of forty pixels (study, step 2).
Background predict_background(const StageMap& map, const ViewSet& views, const View& view,
                              const ViewGain& gain, const cv::Mat& mask, float trust);

}  // namespace sheen::reconstruction
