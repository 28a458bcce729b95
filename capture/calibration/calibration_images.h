// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace sheen::capture {

/// Images to calibrate from: a video file, a folder of images (.jpg, .png, ... in the order of
/// their names), or a session folder, whose recording is taken. All must be of one size. Throws
/// core::Error (bad_input) for a source without images.
std::unique_ptr<FrameSource> open_calibration_images(const std::filesystem::path& source);

/// Whether a file's ending is that of a picture.
bool is_picture_name(const std::filesystem::path& path);

/// The pictures that a folder holds, by name, hidden files left out. Throws core::Error (bad_input)
/// when there is none, naming the kind of those that are not read.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);

}  // namespace sheen::capture
