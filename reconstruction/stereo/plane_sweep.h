// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/stereo/straight_view.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::reconstruction {

/// Where a surface is looked for along the rays of a view's pixels.
struct SweptRange {
  cv::Mat nearest;  ///< CV_32FC1, metres along the optical axis; 0: no surface there
  float step_m = 0;
  int steps = 0;  ///< >= 1
};

/// Depths at which the windows round a view's pixels look alike in the others: a sweep over depths
/// below `nearest` (Collins 1996), compared by normalised correlation of the luma, of which the
/// better half of the others counts, since some do not see the place; made smooth by semi-global
/// matching over eight paths (Hirschmueller 2008). CV_32FC1, metres along the optical axis; 0 where
/// correlation is low or another depth does nearly as well.
cv::Mat sweep_depth(const StraightView& view, const std::vector<const StraightView*>& others,
                    const SweptRange& range);

}  // namespace sheen::reconstruction
