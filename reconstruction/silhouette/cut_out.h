// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/stage/background.h"
#include "reconstruction/stage/learn_stage.h"

#include <opencv2/core/mat.hpp>

namespace sheen::reconstruction {

/// The object in one view.
struct Silhouette {
  cv::Mat labels;         ///< CV_8UC1, PixelLabel
  cv::Mat distance;       ///< CV_32FC1, px from the outline, positive outside
  Background background;  ///< what the view would show without the object
};

/// How exactly outlines are placed.
enum class OutlineDetail { pixels, matted };

/// Cuts the object out of view `index`. `mask` (CV_8UC1, not 0: where the object was found so far;
/// may be empty) tells where to look and leans the decision towards it.
Silhouette cut_out(const LearnedStage& stage, const ViewSet& views, std::size_t index,
                   const cv::Mat& mask, OutlineDetail detail);

}  // namespace sheen::reconstruction
