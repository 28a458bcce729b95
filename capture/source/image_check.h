// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::capture {

/// "640x360"
std::string size_text(const ImageSize& size);

/// Throws core::Error (bad_input) naming both sizes when `size` is not the camera's.
void check_image_size(const std::filesystem::path& subject, const ImageSize& size,
                      const ImageSize& expected);

/// Throws core::Error (bad_input) for a range that no recording can satisfy: negative, empty, or
/// starting past the last of `frames` where that number is known.
void check_range(const std::filesystem::path& subject, const FrameRange& range,
                 std::optional<int> frames);

}  // namespace sheen::capture
