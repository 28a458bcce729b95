// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <filesystem>

namespace sheen::capture {

/// camera.yaml in OpenCV's FileStorage form: image_width, image_height, camera_matrix,
/// distortion_coefficients with 4, 5 or 8 entries. Throws core::Error (bad_input).
core::CameraModel read_camera(const std::filesystem::path& path);
void write_camera(const std::filesystem::path& path, const core::CameraModel& camera);

}  // namespace sheen::capture
