// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sheen::capture {

/// All of a picture's file. Throws core::Error (bad_input): no such file, empty, larger than a
/// picture can be.
std::vector<std::uint8_t> read_picture_bytes(const std::filesystem::path& path);

/// Refuses sizes that no honest file of so many bytes has, before memory is asked for. Throws
/// core::Error (bad_input).
void check_picture_size(const std::filesystem::path& path, const ImageSize& stored,
                        std::uint64_t bytes);

}  // namespace sheen::capture
