// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <filesystem>

namespace sheen::app {

/// Writes sheen-001.png, or the next number that is free, into a folder and returns its path.
/// Throws core::Error.
std::filesystem::path write_snapshot(const cv::Mat& image, const std::filesystem::path& folder);

}  // namespace sheen::app
