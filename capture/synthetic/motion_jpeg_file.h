// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace sheen::capture::synthetic {

/// Writes an AVI file of JPEG pictures. OpenCV's own writer makes files twice as large at the same
/// error and, at low quality, blocks that decoders refuse; its FFmpeg writer has no quality.
class MotionJpegFile {
 public:
  /// `quality` is libjpeg's, [1, 100]. Throws core::Error (run_failed) when the file cannot be
  /// made.
  MotionJpegFile(std::filesystem::path path, cv::Size size_px, int fps, int quality);

  /// Appends a CV_8UC3 picture of the given size. Throws core::Error (run_failed) when the disk is
  /// full or the file would pass 2 GB, the most that every player reads.
  void append(const cv::Mat& picture);

  /// Completes index and headers. Without it the file cannot be played.
  void close();

 private:
  struct Chunk {
    std::uint32_t offset, size;
  };

  [[nodiscard]] std::vector<std::uint8_t> headers() const;
  void check_written() const;

  std::filesystem::path path_;
  cv::Size size_px_;
  int fps_;
  int quality_;
  std::ofstream file_;
  std::uint32_t movie_bytes_ = 4;  ///< of the list of pictures, its name included
  std::vector<Chunk> chunks_;
  std::vector<std::uint8_t> jpeg_;
};

}  // namespace sheen::capture::synthetic
