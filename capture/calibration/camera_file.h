// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <filesystem>

namespace sheen::capture {

/// A camera file of any of the programs that docs/input.md names: OpenCV's FileStorage (YAML, XML,
/// JSON), ROS' camera_info, Kalibr's camchain, Agisoft's calibration, COLMAP's cameras.txt,
/// nerfstudio's transforms.json; with our own key readout_ms beside theirs. Pixels are brought to
/// OpenCV's convention. Throws core::Error (bad_input), for lenses that are not modelled too.
core::CameraModel read_camera(const std::filesystem::path& path);

/// Writes OpenCV's FileStorage form.
void write_camera(const std::filesystem::path& path, const core::CameraModel& camera);

}  // namespace sheen::capture
