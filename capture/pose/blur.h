// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

#include <optional>
#include <vector>

namespace sheen::capture {

/// Width of the tags' edges from 10 to 90 % of their contrast, px: about 1.5 in a sharp image,
/// more by defocus and motion. Motion widens only the edges it crosses, so each tag counts by the
/// wider of its two pairs of sides; the median over the tags is returned. The profiles reach nearly
/// one module to both sides, which bounds what can be measured on small tags. No value when no
/// edge can be measured. `grey` is CV_8UC1.
std::optional<double> tag_edge_width(const cv::Mat& grey, const core::CameraModel& camera,
                                     int modules, const std::vector<TagDetection>& tags);

}  // namespace sheen::capture
