// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"

#include <filesystem>
#include <memory>

namespace sheen::capture {

/// Pictures to calibrate from: a video file, a folder of pictures (.jpg, .png, ... in the order of
/// their names), or a session folder, whose recording is taken. All must be of one size. Throws
/// core::Error (bad_input) for a source without pictures.
std::unique_ptr<FrameSource> open_calibration_pictures(const std::filesystem::path& source);

}  // namespace sheen::capture
