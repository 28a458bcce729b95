// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <string>

namespace sheen::app {

/// Writes sheen-001.png, or the next number that is free, into a folder. Returns what to tell: its
/// name, or why there is none.
std::string save_snapshot(const cv::Mat& image, const std::filesystem::path& folder);

}  // namespace sheen::app
