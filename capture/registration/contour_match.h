// SPDX-License-Identifier: MIT
#pragma once

#include "capture/registration/colour_statistics.h"
#include "capture/registration/contour.h"

#include <opencv2/core/mat.hpp>

#include <optional>

namespace sheen::capture {

/// Where an image has the object's edge, along the line across a contour point.
struct ContourMatch {
  double offset_px = 0;  ///< from the contour point, positive outwards
  double weight = 0;     ///< trust, [0, 1]
};

/// Most probable place at which colours of the object end and those of the surroundings begin,
/// within +-`reach_px` of the point. Works from afar and is not led astray by edges that lie within
/// either side; no sharper than a few pixels. Nothing when the line leaves the image or tells
/// nothing. `image` is CV_8UC3, BGR.
std::optional<ContourMatch> match_by_colour(const cv::Mat& image, const ColourStatistics& colours,
                                            const ContourPoint& point, int reach_px);

/// Place of the strongest brightness or colour edge near the point, to a fraction of a pixel. Edges
/// far from the point count less, and those that the colours contradict.
std::optional<ContourMatch> match_by_edge(const cv::Mat& image, const ColourStatistics& colours,
                                          const ContourPoint& point, double reach_px);

}  // namespace sheen::capture
