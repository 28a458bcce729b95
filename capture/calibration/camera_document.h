// SPDX-License-Identifier: MIT
#pragma once

#include "capture/calibration/lens_record.h"

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::capture {

/// The keys of a camera file of any form that can be taken apart, and what its form says by itself.
struct CameraDocument {
  CameraKeys keys;
  bool is_agisoft = false;             ///< Agisoft's XML: conventions of its own
  std::optional<LensRecord> record{};  ///< COLMAP's cameras.txt, which has no keys
};

/// Takes the text of a camera file apart: YAML (OpenCV's FileStorage, ROS, Kalibr), XML (OpenCV,
/// Agisoft), JSON (OpenCV, nerfstudio), COLMAP's cameras.txt. Long lists, such as the points of a
/// calibration, are passed over. Throws core::Error (bad_input): no such form, nested without end,
/// several cameras.
CameraDocument parse_camera_document(const std::string& text, const std::filesystem::path& path);

}  // namespace sheen::capture
