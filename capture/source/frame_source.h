// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame.h"

#include <optional>

namespace sheen::capture {

/// Images in the order they were taken: a video file, a folder of stills, later a camera.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next image, or nothing at the end. Throws core::Error when the source is broken.
  virtual std::optional<Frame> next() = 0;

  /// Number of frames when the source knows it.
  [[nodiscard]] virtual std::optional<int> frame_count() const = 0;
};

}  // namespace sheen::capture
