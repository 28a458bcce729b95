// SPDX-License-Identifier: MIT
#pragma once

#include "capture/registration/colour_statistics.h"
#include "capture/registration/contour.h"

#include <opencv2/core/mat.hpp>

namespace sheen::capture {

/// Adds an image's colours within the object and round it, both some way off its supposed outline,
/// which may be wrong by `reach_px`. `image` is CV_8UC3, BGR; of a region of more than
/// `most_pixels` pixels of every third row and column fewer are taken.
void learn_colours_of(const cv::Mat& image, const ContourFinder& contours,
                      const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                      double reach_px, int most_pixels, ColourStatistics& colours);

/// Every third pixel of every third row, however many these are.
inline constexpr int kAllPixels = 1 << 30;

}  // namespace sheen::capture
