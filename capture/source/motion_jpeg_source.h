// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"
#include "capture/source/frame_source.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace sheen::capture {

/// Frames of an AVI file of JPEG images, decoded by libjpeg-turbo. Damaged images, which
/// cameras deliver now and then, are left out; the indices of the others count them. Nothing when
/// the file is of another kind. Otherwise as `open_video`.
std::unique_ptr<FrameSource> open_motion_jpeg(const std::filesystem::path& path,
                                              const ImageSize& size, const FrameRange& range,
                                              std::optional<double> fps,
                                              std::optional<double> focal_ratio);

}  // namespace sheen::capture
