// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame.h"

#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// What is to be said about a source of images besides the images.
struct SourceReport {
  int damaged = 0;                 ///< images that came damaged and were left out
  std::vector<std::string> notes;  ///< what was converted or is doubtful, one line each
};

/// Images in the order they were taken: a video file, a folder of stills, later a camera.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next image, or nothing at the end. Throws core::Error when the source is broken.
  virtual std::optional<Frame> next() = 0;

  /// Passes over the next image, without decoding it where the source can; false at the end.
  virtual bool skip() { return next().has_value(); }

  /// Number of frames when the source knows it.
  [[nodiscard]] virtual std::optional<int> frame_count() const = 0;

  /// What there is to say by now; all of it after the last image.
  [[nodiscard]] virtual SourceReport report() const { return {}; }
};

}  // namespace sheen::capture
