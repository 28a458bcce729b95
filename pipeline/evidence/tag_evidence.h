// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_places.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/thinned.h"

#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// Whether the board's ids are those of the print in view. Keeps a few images and looks for their
/// tags only when it is asked: whoever has reason to doubt the poses.
class TagEvidence {
 public:
  TagEvidence(const capture::Board& board, const core::CameraModel& camera);

  void look_at(const capture::Frame& frame);

  /// The board's ids are shifted: every pose is some tags off.
  [[nodiscard]] std::optional<capture::IdFault> fault() const;

  /// Throws core::Error (bad_input) that names the board's file if they are.
  void refuse_shifted(const std::filesystem::path& board) const;

  /// Tags that lie elsewhere than the board says, and such as it does not hold where they are more
  /// than those that it does, or where the object `is_elsewhere` than it says.
  [[nodiscard]] std::vector<Finding> findings(bool is_elsewhere) const;

 private:
  [[nodiscard]] std::vector<std::vector<capture::TagDetection>> tags() const;

  capture::Board board_;
  core::CameraModel camera_;
  Thinned<cv::Mat> greys_;
};

}  // namespace sheen::pipeline
