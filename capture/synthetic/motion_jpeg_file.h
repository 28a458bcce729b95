// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/avi_writer.h"

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sheen::capture::synthetic {

/// Writes an AVI file of images. OpenCV's own writer makes files twice as large at the same error
/// and, at low quality, blocks that decoders refuse; its FFmpeg writer has no quality.
class MotionJpegFile {
 public:
  /// `quality` is libjpeg's, [1, 100]. Throws core::Error when the file cannot be made.
  MotionJpegFile(std::filesystem::path path, cv::Size size_px, int fps, int quality);

  /// Appends a CV_8UC3 image of the given size. Throws core::Error (run_failed) when the disk is
  /// full.
  void append(const cv::Mat& image);

  /// Completes index and headers.
  void close();

 private:
  void check(int fault) const;

  std::filesystem::path path_;
  cv::Size size_px_;
  int quality_;
  AviWriter file_;
  std::vector<std::uint8_t> jpeg_;
};

}  // namespace sheen::capture::synthetic
