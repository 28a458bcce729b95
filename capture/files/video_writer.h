// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <memory>

namespace sheen::capture {

/// Writes an MP4 that browsers, phones and slide shows play: H.264 (MPEG-4 part 2 where FFmpeg was
/// built without x264), 4:2:0, BT.709. Beside the final name, moved into place by `finish`.
class VideoWriter {
 public:
  /// Both sides even; `fps` > 0. Throws core::Error: bad_input when the place cannot be written,
  /// run_failed when no encoder is there.
  VideoWriter(const std::filesystem::path& path, const cv::Size& size, int fps);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  VideoWriter(VideoWriter&&) = delete;
  VideoWriter& operator=(VideoWriter&&) = delete;

  /// CV_8UC3, BGR, of the video's size. Throws core::Error (run_failed).
  void add(const cv::Mat& image);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
