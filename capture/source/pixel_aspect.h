// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::capture {

/// A pixel's width over its height, as videos state it (sample aspect ratio). Poses and intrinsics
/// belong to the stored pixels, of which fy / fx is the aspect.

/// Throws core::Error (bad_input) where the camera file is for the images as players show them,
/// square pixels, and these have another size than the stored ones.
void refuse_shown_size(const std::filesystem::path& subject, const ImageSize& stored,
                       const ImageSize& expected, double pixel_aspect);

/// Where a camera's fy / fx is that of square pixels and the images' are not: to be said, without
/// the file's name. Empty where they agree or the camera is not known.
std::string aspect_doubt(double pixel_aspect, std::optional<double> focal_ratio);

}  // namespace sheen::capture
