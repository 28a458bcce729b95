// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_view.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::capture {

/// Light of the paper around a tag.
struct PaperLight {
  int tag_id = 0;
  Eigen::Vector3d rgb = Eigen::Vector3d::Zero();  ///< linear, > 0; at 1 the image is saturated
};

/// Reads the blank paper around the tags of a board: what changes there from frame to frame while
/// the tag stays where it is, is exposure and white balance.
class PaperReader {
 public:
  /// Boards of families whose tags have no paper around them (a black surround) have nothing to
  /// read.
  PaperReader(const Board& board, const core::CameraModel& camera);

  /// Tags that are seen whole, by id; `image` is CV_8UC3, BGR, of one pose.
  [[nodiscard]] std::vector<PaperLight> read(const cv::Mat& image,
                                             const Eigen::Isometry3d& camera_from_board) const;

 private:
  core::CameraModel camera_;
  std::vector<BoardTag> tags_;
};

}  // namespace sheen::capture
