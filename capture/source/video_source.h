// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"
#include "capture/source/frame_source.h"
#include "capture/source/video_bytes.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace sheen::capture {

/// Frames of a video file in BGR, sRGB colours (capture/source/video_colour.h), stored pixels:
/// turned as the file asks only where the camera file is for the turned images
/// (capture/source/quarter_turn.h). What an edit list hides is not there. Frames before the range
/// are decoded and dropped, since seeking lands on key frames in most files. Times come from the
/// file, or from `fps` where it is given. Damaged frames are left out and counted. Throws
/// core::Error (bad_input): missing file, nothing to decode, another image size (found before this
/// returns), and from `next()` when decoding stops early: more than one frame short of the number
/// the container states and more than two frame times short of its length (containers over-state by
/// a frame, and state frames of even spacing where the recording has gaps, so being short by one of
/// the two only is no fault). `focal_ratio` is fy / fx of the camera, where it is known: pixels
/// that are stated to be of another aspect are noted.
std::unique_ptr<FrameSource> open_video(const std::filesystem::path& path, const ImageSize& size,
                                        const FrameRange& range, std::optional<double> fps,
                                        std::optional<double> focal_ratio = std::nullopt);

/// The same of a video that is still being recorded, called `name` in messages: frames come as
/// `bytes` grows, some behind, and are those that open_video gives of the finished file. Waits for
/// the first. `bytes` is borrowed; what it throws is thrown here and by `next()`.
std::unique_ptr<FrameSource> open_growing_video(const std::filesystem::path& name,
                                                VideoBytes& bytes, const ImageSize& size);

/// Size of a video's stored pixels. Throws core::Error (bad_input).
ImageSize stored_video_size(const std::filesystem::path& path);

/// Width of its pixels over their height, as it states. Throws core::Error (bad_input).
double video_pixel_aspect(const std::filesystem::path& path);

}  // namespace sheen::capture
