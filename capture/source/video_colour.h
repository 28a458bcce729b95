// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <memory>
#include <set>
#include <string>
#include <vector>

struct AVFrame;

namespace sheen::capture {

/// Turns decoded pictures into sRGB as a viewer shows them. The matrix (BT.601, BT.709, BT.2020)
/// and the range are those that the picture states; without a statement BT.601 and the range of its
/// format. Ordinary transfer functions (BT.709 and its kin) count as sRGB, as every player shows
/// them. HLG and PQ are brought to sRGB with reference white (203 cd/m^2) as 1; what is brighter is
/// clipped. Wide primaries (BT.2020, Display P3) are converted. Primaries of BT.601 differ by less
/// than two steps and stay.
class VideoColour {
 public:
  VideoColour();
  ~VideoColour();
  VideoColour(VideoColour&&) noexcept;
  VideoColour& operator=(VideoColour&&) noexcept;
  VideoColour(const VideoColour&) = delete;
  VideoColour& operator=(const VideoColour&) = delete;

  /// Writes the picture as CV_8UC3, BGR. False, with `fault` in words, for pictures whose colours
  /// are coded in a way that is not read.
  [[nodiscard]] bool convert(const AVFrame& picture, cv::Mat& bgr, std::string& fault);

  /// What was converted or is doubtful so far, without the file's name.
  [[nodiscard]] const std::vector<std::string>& notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
