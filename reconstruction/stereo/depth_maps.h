// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/object/work_progress.h"
#include "reconstruction/stereo/straight_view.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::reconstruction {

/// How deep the surface lies in some views.
struct DepthMaps {
  std::vector<StraightView> views;
  std::vector<cv::Mat> depth;  ///< per view CV_32FC1: of the surface; 0: not known
  float pixel_m = 0;           ///< size of a pixel at the object
};

/// Views that are kept out of all that finds depths, so that they can judge what comes of it.
constexpr bool is_judge(std::size_t view_idx) {
  return view_idx % 5 == 2;
}

/// Depths at and below the hull's surface (board frame) by stereo between neighbouring views, each
/// confirmed by the depths of others. Judges, and views that have too few
/// neighbours, know none.
DepthMaps find_depths(const ViewSet& views, const core::Mesh& hull, int threads,
                      const WorkProgress& progress);

}  // namespace sheen::reconstruction
