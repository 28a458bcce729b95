// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sheen::capture {

/// First line of a file of time stamps (docs/session-format.md).
std::string stamps_heading();

/// One line of it: when a frame was taken, microseconds after the first, and the camera's own
/// count.
std::string stamp_line(int index, std::int64_t time_us, std::uint32_t sequence);

/// Seconds as they are read back from a line.
double stamp_seconds(std::int64_t time_us);

/// Seconds of every frame, in order. A last line that was cut short by a crash is left out. Throws
/// core::Error (bad_input) for anything else that is no such file.
std::vector<double> read_stamps(const std::filesystem::path& path);

/// The frames of `source`, none past the last stamp, at the times given for their indices.
std::unique_ptr<FrameSource> with_stamps(std::unique_ptr<FrameSource> source,
                                         std::vector<double> times_s);

}  // namespace sheen::capture
