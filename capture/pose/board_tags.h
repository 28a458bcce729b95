// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::capture {

/// The frame as CV_8UC1: its own plane, shared, or a converted one.
cv::Mat grey_of(const Frame& frame);

/// Finds the tags of one board with refined corners. Keeps its buffers; one thread at a time.
class BoardTagFinder {
 public:
  /// Throws std::invalid_argument for a tag family that no detector knows.
  BoardTagFinder(const Board& board, const core::CameraModel& camera);

  /// Takes the frame as the one to search and returns it as CV_8UC1, valid until the next call.
  const cv::Mat& look_at(const Frame& frame);

  /// Tags of the board in the frame last looked at, sorted by id, no id twice.
  [[nodiscard]] std::vector<TagDetection> find() const;

  [[nodiscard]] const TagFamily& family() const { return family_; }

 private:
  Board board_;
  core::CameraModel camera_;
  TagFamily family_;
  TagDetector detector_;
  cv::Mat buffer_;  // written by us only; a frame's own plane is shared
  cv::Mat grey_;
};

}  // namespace sheen::capture
