// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace sheen::capture {

/// What part of a recording is wanted, counted in frames from its first.
struct FrameRange {
  int start = 0;           ///< first wanted frame, >= 0
  std::optional<int> end;  ///< one past the last; without a value to the end of the recording
};

/// What every image of a recording must look like.
struct ImageSize {
  int width_px = 0;
  int height_px = 0;

  bool operator==(const ImageSize&) const = default;
};

}  // namespace sheen::capture
