// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <string>

namespace sheen::app {

/// The sheet that `sheen board` prints on a paper (one of capture::kPapers), seen from above:
/// CV_8UC3, two pixels a millimetre, without ruler and words.
cv::Mat draw_sheet(const std::string& paper);

}  // namespace sheen::app
