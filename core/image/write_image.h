// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <filesystem>

namespace sheen::core {

/// Writes an image in the format of its ending (.png, .jpg), beside its final name and then moved
/// into place; missing folders are made. Throws Error (bad_input) for an ending no encoder knows
/// and Error (run_failed) when writing fails.
void write_image(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace sheen::core
