// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/avi_writer.h"
#include "capture/session/recorded_video.h"

#include <filesystem>

namespace sheen::capture {

/// JPEG images as an AVI file and a table of their times (docs/session-format.md).
class JpegRecording : public RecordedVideo {
 public:
  /// Makes both files. Throws as AviWriter does.
  JpegRecording(const std::filesystem::path& video, const std::filesystem::path& stamps,
                const ImageSize& size, double fps);

  [[nodiscard]] int append(const LiveImage& image) override;
  [[nodiscard]] int close() override { return video_.close(); }
  [[nodiscard]] int flush() const override;
  [[nodiscard]] std::uint64_t bytes() const override { return video_.bytes(); }

 private:
  AviWriter video_;
  FileHandle stamps_;
  std::uint64_t stamps_end_ = 0;
  int count_ = 0;
};

}  // namespace sheen::capture
