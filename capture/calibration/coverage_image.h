// SPDX-License-Identifier: MIT
#pragma once

#include "capture/calibration/calibrate_camera.h"

#include <opencv2/core/mat.hpp>

namespace sheen::capture {

/// The image area with every point that was seen, coloured by its error, and the error as an
/// arrow made longer by the factor written below; cells without any point are shaded. CV_8UC3.
cv::Mat draw_coverage(const Calibration& calibration);

}  // namespace sheen::capture
