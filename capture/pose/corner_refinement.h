// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

#include <array>

namespace sheen::capture {

/// Moves the corners of a tag to where its four black edges meet: each side is a straight line of
/// the print seen through the lens, fitted to many edge positions, so that one cut or glaring
/// corner does not count. Corners whose sides cannot be measured stay where they are.
/// `grey` is CV_8UC1; `modules` is the number of bits across the black square.
void refine_corners(const cv::Mat& grey, const core::CameraModel& camera, int modules,
                    std::array<Eigen::Vector2d, 4>& corners_px);

}  // namespace sheen::capture
