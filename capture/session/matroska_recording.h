// SPDX-License-Identifier: MIT
#pragma once

#include "capture/files/file_handle.h"
#include "capture/session/matroska_muxer.h"
#include "capture/session/recorded_video.h"

#include <filesystem>

namespace sheen::capture {

/// A compressed video as it came, in Matroska, which holds the times too.
class MatroskaRecording : public RecordedVideo {
 public:
  /// Makes the file. Throws core::Error: bad_input when it exists or cannot be made, run_failed
  /// when the disk is full.
  MatroskaRecording(const std::filesystem::path& path, const VideoHeader& video,
                    const ImageSize& size);

  [[nodiscard]] int append(const LiveImage& image) override;
  [[nodiscard]] int close() override;
  [[nodiscard]] int flush() const override { return file_.flush(); }
  [[nodiscard]] std::uint64_t bytes() const override { return end_; }

 private:
  [[nodiscard]] int put(const std::vector<FilePiece>& pieces);

  FileHandle file_;
  MatroskaMuxer muxer_;
  std::uint64_t end_ = 0;  ///< of what counts
};

}  // namespace sheen::capture
