// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::capture {

/// Finds the tags of one board with refined corners. Keeps its buffers; one thread at a time.
class BoardTagFinder {
 public:
  /// Throws std::invalid_argument for a tag family that no detector knows.
  BoardTagFinder(const Board& board, const core::CameraModel& camera);

  /// Tags of the board in a CV_8UC3 BGR picture, sorted by id, no id twice.
  [[nodiscard]] std::vector<TagDetection> find(const cv::Mat& image);

  /// The picture last searched, CV_8UC1.
  [[nodiscard]] const cv::Mat& grey() const { return grey_; }
  [[nodiscard]] const TagFamily& family() const { return family_; }

 private:
  Board board_;
  core::CameraModel camera_;
  TagFamily family_;
  TagDetector detector_;
  cv::Mat grey_;
};

}  // namespace sheen::capture
